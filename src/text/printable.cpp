#include "text/printable.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace mssim {
namespace {

/// What JSON lets pass unescaped, though terminals take it as commands: DEL, and in UTF-8 the controls from
/// U+0080 to U+009F, which are the bytes C2 80 to C2 9F.
bool is_control(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  return byte(at) == 0x7F || (byte(at) == 0xC2 && at + 1 < text.size() && byte(at + 1) < 0xA0);
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
  std::string result;
  if (text.size() > length) {
    std::size_t end = length;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U)
      --end;  // not within a character
    result = std::string(text.substr(0, end)) + "...";
  } else {
    result = text;
  }
  // The JSON library's writer escapes control characters and replaces what is not UTF-8; quotes are put back.
  using nlohmann::json;
  const std::string escaped = json(result).dump(-1, ' ', false, json::error_handler_t::replace);
  result.clear();
  for (std::size_t i = 1; i + 1 < escaped.size(); ++i) {
    if (escaped[i] == '\\' && (escaped[i + 1] == '"' || escaped[i + 1] == '\\')) ++i;
    if (is_control(escaped, i)) {
      constexpr std::string_view digits = "0123456789abcdef";
      if (escaped[i] != 0x7F) ++i;
      const auto code = static_cast<unsigned char>(escaped[i]);
      result.append("\\u00").append({digits[code >> 4U], digits[code & 0xFU]});
    } else {
      result += escaped[i];
    }
  }
  return result;
}

std::string escaped(std::string_view text) {
  constexpr std::string_view digits = "0123456789abcdef";
  std::string result;
  while (!text.empty()) {
    const std::size_t length = character_length(text);
    const bool plain = length > 0 && static_cast<unsigned char>(text[0]) >= 0x20 && !is_control(text, 0);
    const std::size_t taken = std::max<std::size_t>(length, 1);
    for (const char c : text.substr(0, taken)) {
      const auto code = static_cast<unsigned char>(c);
      if (plain)
        result += c;
      else
        result.append("\\x").append({digits[code >> 4U], digits[code & 0xFU]});
    }
    text.remove_prefix(taken);
  }
  return result;
}

}  // namespace mssim
