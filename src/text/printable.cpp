#include "text/printable.h"

#include <algorithm>

namespace mssim {
namespace {

/// Does the text begin with a control character? In UTF-8 those from U+0080 to U+009F are the bytes C2 80 to
/// C2 9F.
bool is_control(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  return byte(0) < 0x20 || byte(0) == 0x7F || (byte(0) == 0xC2 && text.size() > 1 && byte(1) < 0xA0);
}

std::string hexadecimal_digits(unsigned char code) {
  constexpr std::string_view digits = "0123456789abcdef";
  return {digits[code >> 4U], digits[code & 0xFU]};
}

/// A control character as JSON escapes it.
std::string escape_of(unsigned char code) {
  constexpr std::string_view named = "\b\t\n\f\r", names = "btnfr";
  const std::size_t at = named.find(static_cast<char>(code));
  return at == std::string_view::npos ? "\\u00" + hexadecimal_digits(code) : std::string("\\") + names[at];
}

/// Bytes of the character of valid UTF-8 (RFC 3629) that the text begins with; 0 where it begins with none.
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

}  // namespace

std::string printable(std::string_view text, std::size_t length) {
  const bool is_cut = text.size() > length;
  if (is_cut) {
    std::size_t end = length;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U)
      --end;  // not within a character
    text = text.substr(0, end);
  }
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
      result += plain ? std::string(1, c) : "\\x" + hexadecimal_digits(static_cast<unsigned char>(c));
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

}  // namespace mssim
