#include <algorithm>

#include "output/folders/history_file.h"
#include "output/folders/provenance_file.h"
#include "output/tables/results.h"
#include "report/report_internal.h"
#include "text/text.h"

namespace mssim {
namespace {

std::string element(std::string_view name, std::string_view content, std::string_view attributes = "") {
  return fmt::format("<{0}{1}>{2}</{0}>", name, attributes, content);
}

struct HtmlBlock {
  int shift;  ///< added to the levels of headings

  std::string operator()(const Heading& heading) const {
    const int level = std::clamp(heading.level + shift, 1, 6);
    return element(fmt::format("h{}", level), html_prose(heading.text)) + '\n';
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

/// Style of a report: light and dark, narrow and wide, on paper (A4). Wide tables scroll on a screen, and
/// have smaller text on paper.
constexpr std::string_view page_style = R"(
:root { color-scheme: light dark; --text: #1b1f24; --back: #ffffff; --dim: #57606a; --line: #d0d7de; --fill: #f3f5f7;
  --no: #a40e26; }
@media (prefers-color-scheme: dark) { :root { --text: #e6edf3; --back: #0d1117; --dim: #9da7b3; --line: #3d444d;
  --fill: #161b22; --no: #ff8a80; } }
* { box-sizing: border-box; }
body { margin: 0 auto; padding: 1rem; max-width: 75rem; color: var(--text); background: var(--back);
  font: 16px/1.5 system-ui, sans-serif; overflow-wrap: break-word; }
h1 { font-size: 1.7rem; line-height: 1.2; margin: .5rem 0; }
h2 { font-size: 1.35rem; margin: 2.2rem 0 .6rem; padding-bottom: .2rem; border-bottom: 1px solid var(--line); }
h3 { font-size: 1.1rem; margin: 1.6rem 0 .5rem; }
h4, h5, h6 { font-size: 1rem; margin: 1.2rem 0 .4rem; }
p, ul { margin: .5rem 0; max-width: 60rem; }
ul { padding-left: 1.2rem; }
code { font: .9em ui-monospace, monospace; }
td code, th code { white-space: nowrap; }
a { color: inherit; }
nav ul { list-style: none; padding: 0; display: flex; flex-wrap: wrap; gap: .2rem 1rem; }
.wide { overflow-x: auto; margin: .6rem 0; max-width: 100%; }
table { border-collapse: collapse; font-size: .875rem; font-variant-numeric: tabular-nums; }
th, td { padding: .25rem .6rem; border-bottom: 1px solid var(--line); text-align: left; vertical-align: top;
  font-weight: normal; max-width: 32rem; }
thead th { font-weight: 600; background: var(--fill); vertical-align: bottom; }
.number { text-align: right; white-space: nowrap; }
thead .number { white-space: normal; }
td.number strong, td strong { font-weight: 600; }
.findings { list-style: none; padding: 0; }
.findings li { padding: .3rem .8rem; margin: .4rem 0; border-left: .3rem solid var(--line); background: var(--fill); }
.findings .no { border-left-style: dashed; border-left-color: var(--no); }
.findings .no > strong:first-child { color: var(--no); }
.problems { border-left: .3rem solid var(--no); padding-left: 1.5rem; }
.figures { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(100%, 28rem), 1fr)); gap: 1rem; }
figure { margin: .5rem 0; min-width: 0; }
figure svg, figure img { display: block; width: 100%; height: auto; max-width: 38rem; }
figcaption { color: var(--dim); font-size: .875rem; }
summary { cursor: pointer; margin: .5rem 0; }
@media (max-width: 45rem) { table { width: max-content; } th, td { max-width: 15rem; } }
footer { margin-top: 2rem; color: var(--dim); font-size: .875rem; }
@page { size: A4; margin: 14mm 12mm; }
@media print {
  :root { color-scheme: light; --text: #000000; --back: #ffffff; --dim: #444444; --line: #999999; --fill: #f3f3f3;
    --no: #8a0b1f; }
  body { font-size: 10pt; padding: 0; max-width: none; }
  nav { display: none; }
  details { display: none; }
  .wide { overflow: visible; }
  table { font-size: 7pt; width: 100%; }
  th, td { padding: .1rem .25rem; overflow-wrap: break-word; max-width: none; }
  .number { white-space: normal; }
  h2, h3, h4, h5 { break-after: avoid; }
  figure, tr, .findings li { break-inside: avoid; }
  .figures { grid-template-columns: 1fr 1fr; }
}
)";

/// The points of a guide, with the columns that charts show.
Table points_of(const FoundGuide& guide) {
  Table table;
  for (const GuidePoint& point : guide.points)
    table.add({{"scene", point.scene},
               {"integrator", point.integrator},
               {"backend", point.backend},
               {"dt_s", point.dt_s},
               {"position_error", point.position_error},
               {"wall_s_per_s", point.wall_s_per_s},
               {"force_evaluations_per_s", point.force_evaluations_per_s},
               {"diverged", point.diverged},
               {"on_front", point.on_front},
               {"status", point.status}});
  return table;
}

std::string json_of(const ReportFolder& folder, const ReportInput& input) {
  Table claims{{{"name"}, {"outcome"}, {"published"}, {"measured"}}, {}};
  for (const JudgedClaim& judged : judge(folder, input))
    claims.rows.push_back({judged.claim->name, name_of(judged.outcome), judged.published, judged.measured});
  Table rows{{{"is_warning"}, {"sentence"}}, {}};
  for (const Finding& finding : row_findings(folder.rows, folder.where_from()))
    rows.rows.push_back({finding.is_warning, finding.sentence});
  return "{\"name\": " + json_string(folder.name) + ", \"problems\": [" +
         join(mapped<std::string>(folder.problems, json_string), ", ") +
         "],\n\"claims\": " + json_rows(claims) + ", \"findings\": " + json_rows(rows) +
         ", \"timings\": " + json_rows(timings_table(folder.rows)) +
         (folder.guide ? ", \"guide\": " + json_rows(points_of(*folder.guide)) : "") +
         ", \"provenance\": " + (folder.provenance ? provenance_text(*folder.provenance) : "null") + "}";
}

std::string embedded_data(const ReportInput& input) {
  const auto folders =
      mapped<std::string>(input.folders, [&](const ReportFolder& folder) { return json_of(folder, input); });
  const auto history = mapped<std::string>(input.history, history_line);
  return fmt::format("{{\"made_by\": {}, \"folders\": [\n{}\n]{}}}\n", json_string(input.made_by),
                     join(folders, ",\n"),
                     history.empty() ? "" : fmt::format(", \"history\": [\n{}\n]", join(history, ",\n")));
}

std::string title_of(const ReportInput& input) {
  std::string title = "mssim report";
  for (const ReportFolder& folder : input.folders)
    title += (&folder == &input.folders.front() ? ": " : ", ") + folder.name;
  return html_text(title);
}

}  // namespace

std::string html_text(std::string_view text) {
  std::string result;
  for (std::string_view rest = text; !rest.empty();) {
    const std::size_t line = std::min(rest.find('\n'), rest.size());
    result += xml_text(escaped(rest.substr(0, line)));
    if (line == rest.size()) break;
    result += '\n';
    rest.remove_prefix(line + 1);
  }
  return result;
}

std::string html_prose(std::string_view text) {
  constexpr TextSpelling html{
      html_text, html_text,
      [](TextMark mark, const std::string& content) {
        return element(mark == TextMark::code ? "code" : mark == TextMark::strong ? "strong" : "em", content);
      },
      "<br>"};
  return spelled(text, html);
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
  // The JSON must not end the element; it has "<" only in strings.
  std::string text = fmt::format("<script type=\"application/json\" id=\"{}\">\n", html_text(id));
  for (const char character : json) character == '<' ? text += "\\u003c" : text += character;
  return text + "</script>\n";
}

std::string report_page(const ReportInput& input) {
  std::string links, body;
  const bool only_guides =
      !input.folders.empty() && std::ranges::all_of(input.folders, [](const ReportFolder& folder) {
        return folder.guide && folder.rows.empty();
      });
  for (const PageSection& section : report_sections()) {
    if (section.of_rows && only_guides) continue;
    const std::string content = section.content(input);
    if (content.empty()) continue;
    const std::string id(section.id), title(section.title);
    links += fmt::format("<li><a href=\"#{}\">{}</a></li>\n", id, title);
    body += fmt::format("<section id=\"{}\">\n<h2>{}</h2>\n{}</section>\n", id, title, content);
  }
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
         title_of(input) + "</title>\n<style>" + std::string(page_style) +
         "</style>\n</head>\n<body>\n<header>\n<h1>mssim report</h1>\n<nav><ul>\n" + links +
         "</ul></nav>\n</header>\n<main>\n" + body + "</main>\n<footer>Made by " + html_text(input.made_by) +
         ". The element mssim-data has the data of this page as JSON.</footer>\n" +
         html_data("mssim-data", embedded_data(input)) + "</body>\n</html>\n";
}

}  // namespace mssim
