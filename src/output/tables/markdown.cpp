#include <algorithm>
#include <array>
#include <utility>

#include "output/tables/table.h"
#include "text/text.h"

namespace mssim {
namespace {

/// Escapes text that could begin HTML: names of scenes and devices are arbitrary.
std::string prose(std::string_view text) {
  std::string result;
  for (const char character : text) character == '<' ? result += "&lt;" : result += character;
  return result;
}

/// Escapes text that could end a cell or a line.
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

/// The text without surrounding blanks.
std::string_view without_blanks(std::string_view text) {
  const std::size_t first = text.find_first_not_of(' ');
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(' ') - first + 1);
}

/// Reverses the writer's escaping of characters with a meaning in Markdown.
std::string plain(std::string_view text) {
  constexpr std::array<std::pair<std::string_view, char>, 3> replaced{
      {{"<br>", '\n'}, {"\\|", '|'}, {"&lt;", '<'}}};
  std::string result;
  while (!text.empty()) {
    const auto found = std::find_if(replaced.begin(), replaced.end(),
                                    [&](const auto& pair) { return text.starts_with(pair.first); });
    result += found == replaced.end() ? text.front() : found->second;
    text.remove_prefix(found == replaced.end() ? 1 : found->first.size());
  }
  return result;
}

/// The cells of "| a | b |".
std::vector<std::string> cells_of(std::string_view line) {
  std::vector<std::string> cells;
  std::size_t begin = 1;
  for (std::size_t at = 1; at < line.size(); ++at) {
    if (line[at] != '|' || line[at - 1] == '\\') continue;
    cells.push_back(plain(without_blanks(line.substr(begin, at - begin))));
    begin = at + 1;
  }
  return cells;
}

bool is_rule(std::string_view line) {
  return line.starts_with('|') && line.find_first_not_of("|-: ") == std::string_view::npos;
}

/// The lines of a block whose start looks like a table.
Table table_of(std::string_view head, std::string_view rule, std::string_view rows) {
  Table table;
  for (const std::string& name : cells_of(head)) table.columns.push_back({name, Align::left});
  const std::vector<std::string> sides = cells_of(rule);
  for (std::size_t i = 0; i < std::min(sides.size(), table.columns.size()); ++i)
    if (sides[i].ends_with(':')) table.columns[i].align = Align::right;
  while (!rows.empty()) {
    std::vector<Cell>& row = table.rows.emplace_back();
    for (std::string& cell : cells_of(take_to(rows, "\n"))) row.emplace_back(std::move(cell));
    row.resize(table.columns.size(), Cell(std::string()));
  }
  return table;
}

BulletList list_of(std::string_view block) {
  BulletList list;
  while (!block.empty()) list.items.push_back(plain(without_blanks(take_to(block, "\n").substr(2))));
  return list;
}

bool is_list(std::string_view block) {
  while (!block.empty())
    if (!take_to(block, "\n").starts_with("- ")) return false;
  return true;
}

void add_block(Document& page, std::string_view block) {
  std::string_view rest = block;
  const std::string_view first = take_to(rest, "\n");
  const std::size_t level = std::min(first.find_first_not_of('#'), first.size());
  if (rest.empty() && level >= 1 && level <= 6 && first.substr(level).starts_with(' ')) {
    page.emplace_back(Heading{static_cast<int>(level), plain(without_blanks(first.substr(level)))});
    return;
  }
  if (std::string_view rows = rest; first.starts_with('|')) {
    if (const std::string_view rule = take_to(rows, "\n"); is_rule(rule)) {
      page.emplace_back(table_of(first, rule, rows));
      return;
    }
  }
  if (is_list(block))
    page.emplace_back(list_of(block));
  else
    page.emplace_back(Paragraph{plain(block)});
}

}  // namespace

std::string spelled(std::string_view text, const TextSpelling& spelling) {
  constexpr std::array<std::pair<std::string_view, TextMark>, 3> marks{
      {{"`", TextMark::code}, {"**", TextMark::strong}, {"*", TextMark::emphasis}}};
  std::string result, plain;
  const auto flush = [&] { result += spelling.plain(std::exchange(plain, {})); };
  for (std::size_t at = 0; at < text.size();) {
    const auto mark = std::ranges::find_if(
        marks, [&](const auto& candidate) { return text.substr(at).starts_with(candidate.first); });
    const std::size_t inner = mark == marks.end() ? at : at + mark->first.size();
    const std::size_t end = mark == marks.end() ? inner : text.find(mark->first, inner);
    if (mark != marks.end() && end != std::string_view::npos && end > inner && text[inner] != ' ') {
      flush();
      const std::string_view content = text.substr(inner, end - inner);
      result += spelling.marked(
          mark->second, mark->second == TextMark::code ? spelling.code(content) : spelled(content, spelling));
      at = end + mark->first.size();
    } else if (text[at] == '\n') {
      flush();
      result += spelling.line_end;
      ++at;
    } else {
      plain += text[at++];
    }
  }
  flush();
  return result;
}

void add_sentence(Document& page, const std::string& sentence) {
  if (!sentence.empty()) page.emplace_back(Paragraph{sentence + '.'});
}

std::string markdown(const Document& document) {
  std::string text;
  for (const auto& block : document) {
    if (!text.empty()) text += '\n';
    text += std::visit([](const auto& one) { return text_of(one); }, block);
  }
  return text;
}

Document document_in(std::string_view markdown) {
  markdown = without_byte_order_mark(markdown);
  Document page;
  while (!markdown.empty()) {
    std::string_view block = take_to(markdown, "\n\n");
    while (block.starts_with('\n')) block.remove_prefix(1);
    while (block.ends_with('\n')) block.remove_suffix(1);
    if (!block.empty()) add_block(page, block);
  }
  return page;
}

}  // namespace mssim
