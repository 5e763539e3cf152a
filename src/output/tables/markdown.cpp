#include "output/tables/markdown.h"

#include <string_view>

#include "output/tables/cell_text.h"

namespace mssim {
namespace {

/// Text that begins no HTML: names of scenes and devices are anybody's.
std::string prose(std::string_view text) {
  std::string result;
  for (const char character : text) character == '<' ? result += "&lt;" : result += character;
  return result;
}

/// The text as one that cannot end a cell or a line.
std::string one_cell(std::string_view text) {
  std::string cell;
  for (const char character : prose(text)) {
    if (character == '|')
      cell += "\\|";
    else if (character == '\n')
      cell += "<br>";
    else
      cell += character;
  }
  return cell;
}

std::string text_of(const Heading& heading) {
  return std::string(static_cast<std::size_t>(heading.level), '#') + ' ' + prose(heading.text) + '\n';
}

std::string text_of(const Paragraph& paragraph) { return prose(paragraph.text) + '\n'; }

std::string text_of(const BulletList& list) {
  std::string text;
  for (const std::string& item : list.items) text += "- " + one_cell(item) + '\n';
  return text;
}

std::string text_of(const Table& table) {
  std::string text = "|", rule = "|";
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    text += ' ' + one_cell(table.columns[i].name) + " |";
    rule += is_right_aligned(table, i) ? "---:|" : "---|";
  }
  text += '\n' + rule + '\n';
  for (const std::vector<Cell>& row : table.rows) {
    text += '|';
    for (std::size_t i = 0; i < row.size(); ++i)
      text += ' ' + one_cell(cell_text(row[i], table.columns[i])) + " |";
    text += '\n';
  }
  return text;
}

}  // namespace

std::string markdown(const Document& document) {
  std::string text;
  for (const auto& block : document) {
    if (!text.empty()) text += '\n';
    text += std::visit([](const auto& one) { return text_of(one); }, block);
  }
  return text;
}

}  // namespace mssim
