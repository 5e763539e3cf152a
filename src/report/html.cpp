#include "report/html.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include "output/tables/table.h"
#include "text/text.h"

namespace mssim {
namespace {

std::string element(std::string_view name, std::string_view content, std::string_view attributes = "") {
  std::string text = "<";
  return text.append(name)
      .append(attributes)
      .append(">")
      .append(content)
      .append("</")
      .append(name)
      .append(">");
}

/// A mark of a Document, which is the same in front and behind, and the element that it stands for.
struct Mark {
  std::string_view sign, element;
};
constexpr std::array<Mark, 3> marks{{{"`", "code"}, {"**", "strong"}, {"*", "em"}}};

struct HtmlBlock {
  int shift;  ///< added to the levels of headings

  std::string operator()(const Heading& heading) const {
    const int level = std::clamp(heading.level + shift, 1, 6);
    return element("h" + std::to_string(level), html_prose(heading.text)) + '\n';
  }
  std::string operator()(const Paragraph& paragraph) const {
    return element("p", html_prose(paragraph.text)) + '\n';
  }
  std::string operator()(const BulletList& list) const {
    std::string items;
    for (const std::string& item : list.items) items += element("li", html_prose(item)) + '\n';
    return element("ul", '\n' + items) + '\n';
  }
  std::string operator()(const Table& table) const { return html_of(table); }
};

}  // namespace

std::string html_text(std::string_view text) {
  std::string result;
  for (std::string_view rest = text; !rest.empty();) {
    const std::size_t line = std::min(rest.find('\n'), rest.size());
    for (const char character : escaped(rest.substr(0, line))) {
      if (character == '&')
        result += "&amp;";
      else if (character == '<')
        result += "&lt;";
      else if (character == '>')
        result += "&gt;";
      else if (character == '"')
        result += "&quot;";
      else if (character == '\'')
        result += "&#39;";
      else
        result += character;
    }
    if (line == rest.size()) break;
    result += '\n';
    rest.remove_prefix(line + 1);
  }
  return result;
}

std::string html_prose(std::string_view text) {
  std::string result, plain;
  const auto flush = [&] { result += html_text(std::exchange(plain, {})); };
  for (std::size_t at = 0; at < text.size();) {
    const auto mark = std::ranges::find_if(
        marks, [&](const Mark& candidate) { return text.substr(at).starts_with(candidate.sign); });
    const std::size_t inner = mark == marks.end() ? at : at + mark->sign.size();
    const std::size_t end = mark == marks.end() ? inner : text.find(mark->sign, inner);
    if (mark != marks.end() && end != std::string_view::npos && end > inner && text[inner] != ' ') {
      flush();
      const std::string_view content = text.substr(inner, end - inner);
      result += element(mark->element, mark->sign == "`" ? html_text(content) : html_prose(content));
      at = end + mark->sign.size();
    } else if (text[at] == '\n') {
      flush();
      result += "<br>";
      ++at;
    } else {
      plain += text[at++];
    }
  }
  flush();
  return result;
}

std::string html_of(const Table& table) {
  const auto side = [&](std::size_t column) {
    return is_right_aligned(table, column) ? " class=\"number\"" : "";
  };
  std::string head, body;
  for (std::size_t i = 0; i < table.columns.size(); ++i)
    head += element("th", html_prose(table.columns[i].name), std::string(" scope=\"col\"") + side(i));
  for (const std::vector<Cell>& row : table.rows) {
    std::string cells;
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string content = html_prose(cell_text(row[i], table.columns[i]));
      cells += i == 0 ? element("th", content, std::string(" scope=\"row\"") + side(i))
                      : element("td", content, side(i));
    }
    body += element("tr", cells) + '\n';
  }
  return "<div class=\"wide\" tabindex=\"0\"><table>\n<thead>" + element("tr", head) + "</thead>\n<tbody>\n" +
         body + "</tbody>\n</table></div>\n";
}

std::string html_of(const Document& document, int level) {
  int top = 6;
  for (const auto& block : document)
    if (const auto* heading = std::get_if<Heading>(&block)) top = std::min(top, heading->level);
  std::string text;
  for (const auto& block : document) text += std::visit(HtmlBlock{level - top}, block);
  return text;
}

std::string html_data(std::string_view id, std::string_view json) {
  // Nothing may end the element; in JSON a "<" stands in texts alone.
  std::string text = "<script type=\"application/json\" id=\"" + html_text(id) + "\">\n";
  for (const char character : json)
    if (character == '<')
      text += "\\u003c";
    else
      text += character;
  return text + "</script>\n";
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
