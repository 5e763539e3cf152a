#include "charts/chart_text.h"

#include <algorithm>

#include "text/text.h"

namespace mssim {
namespace {

void replace_all(std::string& text, std::string_view old, std::string_view replacement) {
  for (std::size_t at = 0; (at = text.find(old, at)) != std::string::npos; at += replacement.size())
    text.replace(at, old.size(), replacement);
}

/// Valid UTF-8 without what XML forbids.
std::string clean(std::string_view text) {
  std::string result(text);
  for (const char space : {'\n', '\r', '\t'}) std::ranges::replace(result, space, ' ');
  result = escaped(result);
  for (const std::string_view no_character : {"\xEF\xBF\xBE", "\xEF\xBF\xBF"})
    replace_all(result, no_character, "\uFFFD");
  return result;
}

std::string cut(std::string_view text, std::size_t most) {
  if (width_of(text) <= most) return std::string(text);
  return std::string(clipped(text, most - 1)) + "…";
}

}  // namespace

std::string shown_text(std::string_view text, std::size_t most) { return cut(clean(text), most); }

std::vector<std::string> shown_lines(std::string_view text, std::size_t most) {
  constexpr std::size_t most_lines = 3;
  std::vector<std::string> lines;
  std::string rest = clean(text);
  while (!rest.empty()) {
    if (lines.size() + 1 == most_lines || width_of(rest) <= most) {
      lines.push_back(cut(rest, most));
      break;
    }
    const std::string_view line = clipped(rest, most + 1);
    const std::size_t space = line.find_last_of(' ');
    const std::size_t end =
        space == std::string_view::npos || space == 0 ? clipped(rest, most).size() : space;
    lines.push_back(rest.substr(0, end));
    rest.erase(0, end);
    rest.erase(0, rest.find_first_not_of(' '));
  }
  return lines;
}

std::string gnuplot_text(std::string_view shown) {
  std::string quoted = "'";
  for (const char character : shown) quoted += character == '\'' ? "''" : std::string(1, character);
  return quoted + "'";
}

std::string xml_text(std::string_view shown) {
  std::string text(shown);
  replace_all(text, "&", "&amp;");
  replace_all(text, "<", "&lt;");
  replace_all(text, ">", "&gt;");
  replace_all(text, "\"", "&quot;");
  return text;
}

}  // namespace mssim
