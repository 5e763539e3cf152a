#include "text/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace mssim {
namespace {

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

/// Optimal string alignment distance: Levenshtein's, with a swap of neighbours counting as one edit.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before_last, last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const char x = lower(a[i - 1]), y = lower(b[j - 1]);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (x == y ? 0 : 1)});
      if (i > 1 && j > 1 && x == lower(b[j - 2]) && lower(a[i - 2]) == y)
        row[j] = std::min(row[j], before_last[j - 2] + 1);
    }
    before_last = last;
    last = row;
  }
  return last[b.size()];
}

/// Length from which on the beginning of a name tells which is meant.
constexpr std::size_t telling_length = 4;

/// Whether `name` may be typed by a user who remembers half of `candidate`.
bool are_akin(std::string_view name, std::string_view candidate) {
  return candidate.starts_with(name) || (candidate.size() >= telling_length && name.starts_with(candidate)) ||
         ('-' + std::string(candidate) + '-').find('-' + std::string(name) + '-') != std::string::npos;
}

std::vector<std::string_view> likely_names(std::string_view name,
                                           std::span<const std::string_view> candidates,
                                           std::span<const OtherName> others) {
  constexpr std::size_t most = 4;
  for (const OtherName& other : others)
    if (edit_distance(name, other.typed) == 0) return {other.meant};
  // A name that was begun is meant before a whole one that is as near.
  std::vector<std::string_view> begun;
  for (const std::string_view candidate : candidates)
    if (name.size() >= telling_length && candidate.starts_with(name)) begun.push_back(candidate);
  if (begun.size() == 1) return begun;
  if (const std::string_view nearest = nearest_name(name, candidates); !nearest.empty()) return {nearest};
  std::vector<std::string_view> akin;
  for (const std::string_view candidate : candidates)
    if (are_akin(name, candidate)) akin.push_back(candidate);
  return name.empty() || akin.size() > most ? std::vector<std::string_view>() : akin;
}

/// Does the text begin with a control character? U+0080 to U+009F are the bytes C2 80 to C2 9F in UTF-8.
bool is_control(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  return byte(0) < 0x20 || byte(0) == 0x7F || (byte(0) == 0xC2 && text.size() > 1 && byte(1) < 0xA0);
}

/// A control character as JSON escapes it.
std::string escape_of(unsigned char code) {
  constexpr std::string_view named = "\b\t\n\f\r", names = "btnfr";
  const std::size_t at = named.find(static_cast<char>(code));
  return at == std::string_view::npos ? fmt::format("\\u{:04x}", code) : fmt::format("\\{}", names[at]);
}

/// Bytes of the valid UTF-8 character (RFC 3629) at the beginning of the text; 0 if there is none.
std::size_t character_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned lead = byte(0);
  if (lead < 0x80) return 1;
  const std::size_t length = lead < 0xC2 ? 0 : lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : lead < 0xF5 ? 4 : 0;
  if (length == 0 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((byte(i) & 0xC0U) != 0x80U) return 0;
  const unsigned second = byte(1);
  const bool longer_than_needed = (lead == 0xE0 && second < 0xA0) || (lead == 0xF0 && second < 0x90);
  const bool surrogate = lead == 0xED && second >= 0xA0;
  const bool beyond_unicode = lead == 0xF4 && second >= 0x90;
  return longer_than_needed || surrogate || beyond_unicode ? 0 : length;
}

/// Columns of the character that begins with this byte of UTF-8: two for Chinese and Japanese characters,
/// pictures and others from U+3000 on. 0 within a character.
std::size_t width_of_character(char byte) {
  const auto code = static_cast<unsigned char>(byte);
  if ((code & 0xC0U) == 0x80U) return 0;
  return code < 0xE3 ? 1 : 2;
}

}  // namespace

std::string decimal(double value) {
  std::array<char, 32> text;
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

std::string fixed_decimal(double value, int digits) { return fmt::format("{:.{}f}", value, digits); }

std::string three_digits(double value) {
  // Rounding may carry into one more digit: 9.996 is 10.0.
  const double rounded = std::abs(number_in<double>(fmt::format("{:.2e}", value)).value_or(0));
  const int exponent = rounded > 0 ? static_cast<int>(std::floor(std::log10(rounded))) : 0;
  return fixed_decimal(value, std::max(0, 2 - exponent));
}

std::string two_digits(double value) { return fmt::format("{:.2g}", value); }

std::string grouped(std::uint64_t number) {
  std::string text = std::to_string(number);
  for (std::size_t at = text.size(); at > 3; at -= 3) text.insert(at - 3, 1, ',');
  return text;
}

std::string to_hex(std::uint64_t value) { return fmt::format("{:016x}", value); }

std::optional<std::uint64_t> from_hex(std::string_view text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, 16);
  if (error != std::errc() || end != text.data() + text.size() || to_hex(value) != text) return std::nullopt;
  return value;
}

std::string_view take_to(std::string_view& text, std::string_view end) {
  const std::string_view part = text.substr(0, text.find(end));
  text.remove_prefix(std::min(part.size() + end.size(), text.size()));
  return part;
}

std::string join(std::span<const std::string> texts, std::string_view separator) {
  return fmt::format("{}", fmt::join(texts, separator));
}

std::string xml_text(std::string_view text) {
  constexpr auto entities = std::to_array<std::pair<char, std::string_view>>(
      {{'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}, {'\'', "&#39;"}});
  std::string result;
  for (const char character : text) {
    const auto found = std::ranges::find(entities, character, &std::pair<char, std::string_view>::first);
    found == entities.end() ? result.append(1, character) : result.append(found->second);
  }
  return result;
}

void append_sentence(std::string& note, std::string_view sentence) {
  if (!note.empty() && !sentence.empty()) note += "; ";
  note += sentence;
}

std::string to_lower(std::string_view text) {
  std::string result(text);
  std::ranges::transform(result, result.begin(), lower);
  return result;
}

std::string_view nearest_name(std::string_view name, std::span<const std::string_view> candidates) {
  std::string_view nearest;
  std::size_t nearest_distance = 0;
  for (const std::string_view candidate : candidates) {
    const std::size_t allowed = std::max<std::size_t>(1, candidate.size() / 3);
    // Also keeps a name of megabytes from allocating a table of megabytes.
    if (name.size() > candidate.size() + allowed) continue;
    const std::size_t distance = edit_distance(name, candidate);
    if (distance > allowed || (!nearest.empty() && distance >= nearest_distance)) continue;
    nearest = candidate;
    nearest_distance = distance;
  }
  return nearest;
}

std::string did_you_mean(std::string_view name, std::span<const std::string_view> candidates,
                         std::span<const OtherName> others) {
  const std::vector<std::string_view> likely = likely_names(name, candidates, others);
  return likely.empty() ? "" : fmt::format(" (did you mean {}?)", listed(likely, "or"));
}

std::string listed(std::span<const std::string_view> names, std::string_view last_word) {
  std::string list;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0 && i + 1 < names.size()) list += ", ";
    if (i > 0 && i + 1 == names.size()) list.append(" ").append(last_word).append(" ");
    list += names[i];
  }
  return list;
}

std::string listed(const std::vector<std::string>& names, std::string_view last_word) {
  return listed(std::vector<std::string_view>(names.begin(), names.end()), last_word);
}

std::string unknown_name(std::string_view what, std::string_view name,
                         std::span<const std::string_view> known, std::span<const OtherName> others) {
  return fmt::format("unknown {} \"{}\"{}: known are {}", what, printable(name),
                     did_you_mean(name, known, others), listed(known));
}

std::string_view beginning_of(std::string_view text, std::size_t bytes) {
  if (text.size() <= bytes) return text;
  while (bytes > 0 && width_of_character(text[bytes]) == 0) --bytes;  // not within a character
  return text.substr(0, bytes);
}

std::string printable(std::string_view text, std::size_t length) {
  const bool is_cut = text.size() > length;
  text = beginning_of(text, length);
  std::string result;
  while (!text.empty()) {
    const std::size_t taken = character_length(text);
    if (taken == 0)
      result += "\uFFFD";
    else if (is_control(text))
      result += escape_of(static_cast<unsigned char>(text[taken - 1]));
    else
      result += text.substr(0, taken);
    text.remove_prefix(std::max<std::size_t>(taken, 1));
  }
  return is_cut ? result + "..." : result;
}

std::string escaped(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const std::size_t length = character_length(text);
    const bool plain = length > 0 && !is_control(text);
    const std::size_t taken = std::max<std::size_t>(length, 1);
    for (const char c : text.substr(0, taken))
      result += plain ? std::string(1, c) : fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    text.remove_prefix(taken);
  }
  return result;
}

bool has_words(std::string_view line) {
  return std::ranges::any_of(line, [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte >= 0x80 || (byte >= '0' && byte <= '9') || ((byte | 0x20U) >= 'a' && (byte | 0x20U) <= 'z');
  });
}

std::string shell_word(const std::string& text) {
  const bool plain = !text.empty() && text.find_first_not_of(
                                          "abcdefghijklmnopqrstuvwxyz"
                                          "ABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                          "0123456789_-+=:,./~%@") == std::string::npos;
  if (plain) return text;
  std::string word = "'";
  for (const char c : text) {
    if (c == '\'')
      word += "'\\'";  // closes the quotes, adds a quoted quote; the next character opens them again
    word += c;
  }
  word += '\'';
  return word;
}

Character first_character(std::string_view text) {
  const std::size_t bytes = character_length(text);
  if (bytes == 0) return {U'\uFFFD', 1};
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  char32_t code = bytes == 1 ? byte(0) : byte(0) & (0xFFU >> (bytes + 1));
  for (std::size_t i = 1; i < bytes; ++i) code = code << 6 | (byte(i) & 0x3FU);
  return {code, bytes};
}

std::size_t width_of(std::string_view text) {
  std::size_t width = 0;
  for (const char byte : text) width += width_of_character(byte);
  return width;
}

std::string_view clipped(std::string_view text, std::size_t width) {
  std::size_t end = 0, seen = 0;
  for (; end < text.size(); ++end)
    if ((seen += width_of_character(text[end])) > width) break;
  return text.substr(0, end);
}

std::string wrapped(std::string_view text, std::size_t width, std::string_view indent) {
  std::string lines, line;
  while (!text.empty()) {
    const std::string_view word = take_to(text, " ");
    if (!line.empty() && width_of(line) + 1 + width_of(word) > width) {
      lines += line + '\n';
      line = indent;
    } else if (!line.empty()) {
      line += ' ';
    }
    line += word;
  }
  return lines + line;
}

std::string bar(double fraction, std::size_t width, bool utf8) {
  const std::size_t parts = utf8 ? 8 : 1;
  const auto whole = static_cast<double>(width * parts);
  auto filled = static_cast<std::size_t>(std::lround(std::clamp(fraction, 0.0, 1.0) * whole));
  if (fraction > 0) filled = std::max<std::size_t>(filled, 1);
  if (!utf8) return std::string(filled, '#');
  constexpr std::string_view eighths[] = {"", "▏", "▎", "▍", "▌", "▋", "▊", "▉"};
  std::string text;
  for (std::size_t i = 0; i < filled / parts; ++i) text += "█";
  return text.append(eighths[filled % parts]);
}

std::string_view without_byte_order_mark(std::string_view text) {
  constexpr std::string_view mark = "\xef\xbb\xbf";
  return text.starts_with(mark) ? text.substr(mark.size()) : text;
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - at);
    std::uint32_t group = 0;
    for (std::size_t i = 0; i < 3; ++i)
      group = group << 8 | (i < count ? static_cast<unsigned char>(bytes[at + i]) : 0U);
    for (std::size_t i = 0; i < 4; ++i) text += i <= count ? digits[group >> (18 - 6 * i) & 63U] : '=';
  }
  return text;
}

}  // namespace mssim
