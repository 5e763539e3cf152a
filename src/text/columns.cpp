#include "text/columns.h"

#include <algorithm>
#include <cmath>

namespace mssim {
namespace {

/// Columns of the character that begins with this byte of UTF-8: Chinese and Japanese characters, pictures
/// and what else begins at U+3000 take two. 0 within a character.
std::size_t width_of_character(char byte) {
  const auto code = static_cast<unsigned char>(byte);
  if ((code & 0xC0U) == 0x80U) return 0;
  return code < 0xE3 ? 1 : 2;
}

}  // namespace

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
    const std::string_view word = text.substr(0, text.find(' '));
    text.remove_prefix(std::min(text.size(), word.size() + 1));
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

}  // namespace mssim
