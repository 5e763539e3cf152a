#pragma once

#include <fmt/core.h>

#include <charconv>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace mssim {

/// Numbers and names as texts, for messages, tables and files; no file is read or written here. Sentences are
/// put together by fmt::format(), which comes with this header.

/// The shortest decimal text that reads back as the same number, in every locale.
std::string decimal(double value);

/// Three significant digits, without an exponent.
std::string three_digits(double value);

/// Two significant digits, with an exponent where the number is small or large ("2.1e-07"): for numbers that
/// differ by orders of magnitude.
std::string two_digits(double value);

/// With `digits` behind the point, rounded, without an exponent.
std::string fixed_decimal(double value, int digits);

/// 4188004 as 4,188,004.
std::string grouped(std::uint64_t number);

/// The text as a number, in every locale and with or without a sign; none where it is anything else, has
/// anything beside the number, or does not fit.
template <class Number>
std::optional<Number> number_in(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  Number number{};
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  return error == std::errc() && stop == end ? std::optional(number) : std::nullopt;
}

/// The numbers that commas separate; none at all where something else stands between two of them.
template <class Number>
std::vector<Number> numbers_in(std::string_view text) {
  std::vector<Number> numbers;
  for (;;) {
    const std::size_t comma = text.find(',');
    const std::optional<Number> number = number_in<Number>(text.substr(0, comma));
    if (!number) return {};
    numbers.push_back(*number);
    if (comma == std::string_view::npos) return numbers;
    text.remove_prefix(comma + 1);
  }
}

/// FNV-1a of the text's bytes, 64 bits: tells files apart that differ by accident, not by intent.
/// Source: G. Fowler, L. C. Noll, K.-P. Vo, D. Eastlake, The FNV Non-Cryptographic Hash Algorithm, IETF
/// draft. `hash`: that of what stands before it.
constexpr std::uint64_t fnv1a_64(std::string_view text, std::uint64_t hash = 0xcbf29ce484222325) {
  for (const char character : text) {
    hash ^= static_cast<unsigned char>(character);
    hash *= 0x100000001b3;
  }
  return hash;
}

/// 16 hexadecimal digits.
std::string to_hex(std::uint64_t value);

/// The value that to_hex() wrote, none for any other text.
std::optional<std::uint64_t> from_hex(std::string_view text);

/// "1 thread", "2 threads": a number and a noun whose plural ends in s.
std::string pluralize(std::integral auto number, std::string_view noun) {
  return fmt::format("{} {}{}", number, noun, number == 1 ? "" : "s");
}

/// The texts one behind the other, with `separator` between each two.
std::string join(std::span<const std::string> texts, std::string_view separator);

/// With entities in place of what ends a text or a quoted attribute in XML and HTML: & < > " '.
std::string xml_text(std::string_view text);

/// The candidate that `name` is most likely a misspelling of, or empty when none is near: at most a third of
/// its letters (and always up to one) inserted, deleted, replaced or swapped with a neighbour, capitals
/// counting as small letters.
std::string_view nearest_name(std::string_view name, std::span<const std::string_view> candidates);

/// A word that users type for a name that is spelt otherwise.
struct OtherName {
  std::string_view typed, meant;
};

/// " (did you mean A or B?)", or nothing: the name that `name` stands for in `others`, the nearest candidate,
/// or, where none is near, up to four candidates that begin with it, that it begins with (from four letters
/// on), or that have it between their hyphens.
std::string did_you_mean(std::string_view name, std::span<const std::string_view> candidates,
                         std::span<const OtherName> others = {});

/// "a, b and c", or with another last word "a, b or c".
std::string listed(std::span<const std::string_view> names, std::string_view last_word = "and");
std::string listed(const std::vector<std::string>& names, std::string_view last_word = "and");

/// The complaint about a name that is none of the known: "unknown WHAT "NAME" (did you mean NEAREST?): known
/// are A, B and C".
std::string unknown_name(std::string_view what, std::string_view name,
                         std::span<const std::string_view> known, std::span<const OtherName> others = {});

/// Adds a sentence to a note, which reads "one; another". An empty sentence changes nothing.
void append_sentence(std::string& note, std::string_view sentence);

/// The text with A to Z as a to z, in every locale.
std::string to_lower(std::string_view text);

/// `text`, which may hold anything, for an error message: on one line, valid UTF-8 without control characters
/// (they are written as escapes), cut to about `length` bytes.
std::string printable(std::string_view text, std::size_t length = 80);

/// `text`, which may hold anything (a file's name, an argument), as a name that goes into files: valid UTF-8
/// without control characters. A byte that is none of valid UTF-8, and each byte of a control character, is
/// written as \xHH; all else stays as it is.
std::string escaped(std::string_view text);

/// Whether a line says anything: it has a letter, a digit or a byte beyond ASCII. The frames that programs
/// draw around what they say have none.
bool has_words(std::string_view line);

/// The text as one word of a shell's command: in single quotes unless all its characters are plain.
std::string shell_word(const std::string& text);

/// Columns that UTF-8 takes, in a terminal or in letters of a chart: one a character, two for wide ones.
std::size_t width_of(std::string_view text);

/// What of UTF-8 fits into so many columns.
std::string_view clipped(std::string_view text, std::size_t width);

/// `text` in lines of at most `width` characters, broken between words, those but the first behind `indent`.
/// A word that is longer than a line stays whole.
std::string wrapped(std::string_view text, std::size_t width, std::string_view indent);

/// A bar of at most `width` characters for a fraction from 0 to 1, in eighths of a character with UTF-8, else
/// of whole #. What is above zero is seen.
std::string bar(double fraction, std::size_t width, bool utf8);

/// The text without the byte-order mark that some editors and spreadsheets put before UTF-8.
std::string_view without_byte_order_mark(std::string_view text);

}  // namespace mssim
