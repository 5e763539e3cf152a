#include "report/page.h"

#include <algorithm>
#include <array>

#include "report/embedded_data.h"
#include "report/html.h"
#include "report/page_style.h"
#include "report/sections.h"

namespace mssim {
namespace {

struct Section {
  std::string_view id, title;
  std::string (*content)(const ReportInput& input);
  bool of_rows = true;  ///< it shows what mssim bench has measured
};

/// In the order in which they stand; one without content is left out.
constexpr std::array<Section, 12> sections{{
    {"machine", "Machine and settings", machine_section, false},
    {"verdict", "Verdict", verdict_section},
    {"changes", "What changed", changes_section},
    {"headline", "Times", headline_section},
    {"published", "Published beside measured", published_section},
    {"guide", "Guide", guide_section, false},
    {"speed-up", "Speed-up", speedup_section},
    {"scaling", "Scaling", scaling_section},
    {"roofline", "Roofline", roofline_section},
    {"energy", "Energy", energy_section},
    {"pictures", "Pictures", picture_section},
    {"provenance", "Provenance", provenance_section, false},
}};

/// Whether all that there is are guides, which have no rows.
bool has_only_guides(const ReportInput& input) {
  return !input.folders.empty() && std::ranges::all_of(input.folders, [](const ReportFolder& folder) {
    return folder.guide && folder.rows.empty();
  });
}

std::string title_of(const ReportInput& input) {
  std::string title = "mssim report";
  for (const ReportFolder& folder : input.folders)
    title += (&folder == &input.folders.front() ? ": " : ", ") + folder.name;
  return html_text(title);
}

}  // namespace

std::string report_page(const ReportInput& input) {
  std::string links, body;
  const bool rows = !has_only_guides(input);
  for (const Section& section : sections) {
    if (section.of_rows && !rows) continue;
    const std::string content = section.content(input);
    if (content.empty()) continue;
    const std::string id(section.id), title(section.title);
    links += "<li><a href=\"#" + id + "\">" + title + "</a></li>\n";
    body += "<section id=\"" + id + "\">\n<h2>" + title + "</h2>\n" + content + "</section>\n";
  }
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
         title_of(input) + "</title>\n<style>" + std::string(page_style) +
         "</style>\n</head>\n<body>\n<header>\n<h1>mssim report</h1>\n<nav><ul>\n" + links +
         "</ul></nav>\n</header>\n<main>\n" + body + "</main>\n<footer>Made by " + html_text(input.made_by) +
         ". The data of this page stand in it as JSON, in the element mssim-data.</footer>\n" +
         html_data("mssim-data", embedded_data(input)) + "</body>\n</html>\n";
}

}  // namespace mssim
