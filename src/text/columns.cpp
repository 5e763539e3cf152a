#include "text/columns.h"

#include <algorithm>
#include <cmath>

namespace mssim {
namespace {

bool begins_character(char byte) { return (static_cast<unsigned char>(byte) & 0xC0) != 0x80; }

}  // namespace

std::size_t width_of(std::string_view text) {
  return static_cast<std::size_t>(std::ranges::count_if(text, begins_character));
}

std::string_view clipped(std::string_view text, std::size_t width) {
  std::size_t end = 0;
  for (std::size_t seen = 0; end < text.size(); ++end)
    if (begins_character(text[end]) && seen++ == width) break;
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
