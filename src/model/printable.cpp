#include "model/printable.h"

#include <nlohmann/json.hpp>

namespace mssim {
namespace {

/// What JSON lets pass unescaped, though terminals take it as commands: DEL, and in UTF-8 the controls from
/// U+0080 to U+009F, which are the bytes C2 80 to C2 9F.
bool is_control(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  return byte(at) == 0x7F || (byte(at) == 0xC2 && at + 1 < text.size() && byte(at + 1) < 0xA0);
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

}  // namespace mssim
