#pragma once

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <vector>

namespace mssim {

/// Numbers and names as text, for messages, tables and files, and lists of any values; no I/O. Sentences are
/// made with fmt::format(), which this header includes.

/// The shortest decimal text that reads back as the same number, in every locale.
std::string decimal(double value);

/// Three significant digits, without an exponent.
std::string three_digits(double value);

/// Two significant digits, with an exponent if the number is small or large ("2.1e-07"): for numbers that
/// differ by orders of magnitude.
std::string two_digits(double value);

/// With `digits` decimals, rounded, without an exponent.
std::string fixed_decimal(double value, int digits);

/// 4188004 as 4,188,004.
std::string grouped(std::uint64_t number);

/// The text as a number, in every locale and with or without a sign; nothing if it has anything besides the
/// number or does not fit.
template <class Number>
std::optional<Number> number_in(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  Number number{};
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  return error == std::errc() && stop == end ? std::optional(number) : std::nullopt;
}

/// Numbers separated by commas; empty if any part is not a number.
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

/// Values of `of`, a member or a function, for each element, in order.
template <class Value, class Range, class Of>
std::vector<Value> mapped(Range&& range, Of of) {
  std::vector<Value> values;
  for (auto&& element : range) values.emplace_back(std::invoke(of, element));
  return values;
}

/// The first element for which `of`, a member or a function, has this value; null if there is none.
template <class Range, class Value, class Of>
auto found_in(Range& range, const Value& value, Of of) {
  const auto found = std::ranges::find(range, value, of);
  return found == std::ranges::end(range) ? nullptr : &*found;
}

/// The places of a range's elements in the order of the values of `of`; equal ones stay in theirs.
template <class Compare = std::ranges::less, class Range, class Of = std::identity>
std::vector<std::size_t> ordered_places(const Range& range, Of of = {}) {
  std::vector<std::size_t> places(std::size(range));
  std::iota(places.begin(), places.end(), std::size_t{0});
  std::ranges::stable_sort(places, Compare(), [&](std::size_t i) { return std::invoke(of, range[i]); });
  return places;
}

/// Adds the value unless it is there.
template <class Value>
void add_once(std::vector<Value>& values, const std::type_identity_t<Value>& value) {
  if (std::ranges::find(values, value) == values.end()) values.push_back(value);
}

/// Values of `of`, a member or a function, for each element: each value once, in the order of the first.
template <class Value, class Range, class Of>
std::vector<Value> distinct(Range&& range, Of of) {
  std::vector<Value> values;
  for (auto&& element : range) add_once(values, std::invoke(of, element));
  return values;
}

/// The bytes of a value without pointers, or of a vector of such values, for hashes and files.
template <class Value>
requires std::is_trivially_copyable_v<Value> std::string_view bytes_of(const Value& value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}
template <class Value>
requires std::is_trivially_copyable_v<Value> std::string_view bytes_of(const std::vector<Value>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value)};
}

/// FNV-1a of the text's bytes, 64 bits: detects accidental, not deliberate, differences between files.
/// Source: G. Fowler, L. C. Noll, K.-P. Vo, D. Eastlake, The FNV Non-Cryptographic Hash Algorithm, IETF
/// draft. `hash`: the hash of the preceding text.
constexpr std::uint64_t fnv1a_64(std::string_view text, std::uint64_t hash = 0xcbf29ce484222325) {
  for (const char character : text) {
    hash ^= static_cast<unsigned char>(character);
    hash *= 0x100000001b3;
  }
  return hash;
}

/// 16 hexadecimal digits.
std::string to_hex(std::uint64_t value);

/// The value that to_hex() wrote; nothing for any other text.
std::optional<std::uint64_t> from_hex(std::string_view text);

/// "1 thread", "2 threads": a number and a noun whose plural ends in s.
std::string pluralize(std::integral auto number, std::string_view noun) {
  return fmt::format("{} {}{}", number, noun, number == 1 ? "" : "s");
}

/// Removes the text up to `end`, and `end` itself, from its front and returns it; all of it without `end`.
std::string_view take_to(std::string_view& text, std::string_view end);

/// The concatenated texts, with `separator` between them.
std::string join(std::span<const std::string> texts, std::string_view separator);

/// Replaces the characters & < > " ' by entities, for text and quoted attributes in XML and HTML.
std::string xml_text(std::string_view text);

/// The candidate that `name` most likely misspells, or empty if none is near: at most a third of its letters
/// (always at least one) inserted, deleted, replaced or swapped with a neighbour, ignoring case.
std::string_view nearest_name(std::string_view name, std::span<const std::string_view> candidates);

/// A word that users type for a name that has another spelling.
struct OtherName {
  std::string_view typed, meant;
};

/// " (did you mean A or B?)", or nothing. Suggests the name that `others` gives for `name`, else the nearest
/// candidate, else up to four candidates that begin with it, that it begins with (from four letters on), or
/// that contain it between hyphens.
std::string did_you_mean(std::string_view name, std::span<const std::string_view> candidates,
                         std::span<const OtherName> others = {});

/// "a, b and c", or with another last word "a, b or c".
std::string listed(std::span<const std::string_view> names, std::string_view last_word = "and");
std::string listed(const std::vector<std::string>& names, std::string_view last_word = "and");

/// The error for an unknown name: "unknown WHAT "NAME" (did you mean NEAREST?): known are A, B and C".
std::string unknown_name(std::string_view what, std::string_view name,
                         std::span<const std::string_view> known, std::span<const OtherName> others = {});

/// Adds a sentence to a note, which reads "one; another". An empty sentence changes nothing.
void append_sentence(std::string& note, std::string_view sentence);

/// The text in lower case (A to Z only), in every locale.
std::string to_lower(std::string_view text);

/// Arbitrary text for an error message: on one line, valid UTF-8 without control characters (they are
/// escaped), cut to about `length` bytes.
std::string printable(std::string_view text, std::size_t length = 80);

/// Arbitrary text (a file's name, an argument) as a name for files: valid UTF-8 without control characters.
/// Each byte of invalid UTF-8 or of a control character is written as \xHH; the rest is unchanged.
std::string escaped(std::string_view text);

/// Whether a line has text: a letter, a digit or a byte beyond ASCII. Lines of frames that programs draw have
/// none.
bool has_words(std::string_view line);

/// The text as one word of a shell command: in single quotes unless all its characters are plain.
std::string shell_word(const std::string& text);

/// A character of UTF-8 (RFC 3629).
struct Character {
  char32_t code;
  std::size_t bytes;
};

/// The first character of a text, which is not empty. A byte that begins none counts as U+FFFD.
Character first_character(std::string_view text);

/// Columns of UTF-8 text in a terminal or chart: one per character, two for wide ones.
std::size_t width_of(std::string_view text);

/// At most the first `bytes` bytes of UTF-8 text, without a partial character.
std::string_view beginning_of(std::string_view text, std::size_t bytes);

/// The longest prefix of UTF-8 text that fits into `width` columns.
std::string_view clipped(std::string_view text, std::size_t width);

/// `text` in lines of at most `width` characters, broken between words; lines after the first begin with
/// `indent`. A word longer than a line stays whole.
std::string wrapped(std::string_view text, std::size_t width, std::string_view indent);

/// A bar of at most `width` characters for a fraction from 0 to 1, in eighths of a character with UTF-8, else
/// of whole #. Any value above zero is visible.
std::string bar(double fraction, std::size_t width, bool utf8);

/// The text without the byte-order mark that some editors and spreadsheets put before UTF-8.
std::string_view without_byte_order_mark(std::string_view text);

/// The bytes in base 64 (RFC 4648), for pages that hold pictures or data.
std::string base64(std::string_view bytes);

}  // namespace mssim
