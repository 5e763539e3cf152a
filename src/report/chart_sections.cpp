#include <algorithm>
#include <exception>

#include "charts/chart.h"
#include "report/guide_charts.h"
#include "report/html.h"
#include "report/report_charts.h"
#include "report/sections.h"
#include "text/text.h"

namespace mssim {
namespace {

/// A chart, or the sentence why there is none.
std::string figure_of(const Chart& chart) {
  const DrawnChart drawn = draw_svg(chart);
  if (drawn.svg.empty())
    return "<p class=\"problems\">" + html_text(chart.title) +
           ": no chart, because there is no value to draw.</p>\n";
  // The chart has its title in it.
  const std::string notes =
      drawn.notes.empty() ? "" : "<figcaption>" + html_text(join(drawn.notes, ". ")) + ".</figcaption>";
  return "<figure>" + drawn.svg + notes + "</figure>\n";
}

std::string figures_of(const std::vector<Chart>& charts) {
  std::string text;
  for (const Chart& chart : charts) text += figure_of(chart);
  return text.empty() ? text : "<div class=\"figures\">\n" + text + "</div>\n";
}

std::string pictures_of(const std::vector<FoundPicture>& pictures) {
  std::string text;
  for (const FoundPicture& picture : pictures)
    text += "<figure><img alt=\"" + html_text(picture.caption) + "\" src=\"data:image/png;base64," +
            base64(picture.png) + "\"><figcaption>" + html_text(picture.caption) + "</figcaption></figure>\n";
  return text.empty() ? text : "<div class=\"figures\">\n" + text + "</div>\n";
}

/// What `content` makes of each folder and its number, below its name; `without` where all of it is empty.
template <class Content>
std::string of_each_folder(const ReportInput& input, const std::string& without, Content content) {
  std::string text;
  for (std::size_t i = 0; i < input.folders.size(); ++i)
    if (const std::string part = content(input.folders[i], id_of(i)); !part.empty())
      text += folder_heading(input, input.folders[i]) + part;
  return text.empty() ? without : text;
}

}  // namespace

std::string speedup_section(const ReportInput& input) {
  return "<p>Published lines are dashed, with open points; measured ones have intervals. Both axes are "
         "logarithmic "
         "in charts of speed-ups, and neither in Figure 6 of Vassilev, which shows its own times as curves "
         "without numbers.</p>\n" +
         of_each_folder(
             input, "<p>No folder has a scene of the papers with a speed-up.</p>\n",
             [&](const ReportFolder& folder, const std::string& id) {
               std::vector<Chart> charts;
               for (const PublishedTable& published : input.published) {
                 const PaperScenes scenes(folder.rows, input.legend, published);
                 for (Chart& chart : speedup_charts(scenes, id + "-" + std::string(published.info().name)))
                   charts.push_back(std::move(chart));
               }
               if (auto figure6 = figure6_chart(folder.rows, id)) charts.push_back(std::move(*figure6));
               return figures_of(charts);
             });
}

std::string scaling_section(const ReportInput& input) {
  return "<p>A slope is the exponent p of time ~ nodes<sup>p</sup>, by least squares on logarithmic axes: 1 "
         "where a "
         "node costs the same at every size.</p>\n" +
         of_each_folder(input, "<p>No folder has two sizes of a kind of scene.</p>\n",
                        [&](const ReportFolder& folder, const std::string& id) {
                          const Table slopes = slope_table(folder.rows, input.legend, input.published);
                          return figures_of(scaling_charts(folder.rows, input.legend, input.published, id)) +
                                 (slopes.rows.empty() ? "" : html_of(slopes));
                        });
}

namespace {

/// The page of a guide from a heading of this level to the next one: what comes before the first is a part of
/// its own, without a heading.
std::vector<Document> parts_of(const Document& page, int level) {
  std::vector<Document> parts(1);
  for (const auto& block : page) {
    const auto* heading = std::get_if<Heading>(&block);
    if (heading && heading->level == level) parts.emplace_back();
    parts.back().push_back(block);
  }
  return parts;
}

const std::string& heading_of(const Document& part) { return std::get<Heading>(part.front()).text; }

/// Is the part about the scene? Headings go on with its size.
bool is_about(const Document& part, const std::string& scene) {
  return heading_of(part) == scene || heading_of(part).starts_with(scene + ":");
}

std::string to_unfold(const std::string& summary, const Document& blocks, int level) {
  return blocks.empty() ? ""
                        : "<details><summary>" + html_text(summary) + "</summary>\n" +
                              html_of(blocks, level) + "</details>\n";
}

/// What the page says of a scene in words, the charts, and the page's tables to unfold.
std::string guide_of_scene(const Document& scene, const std::vector<Chart>& charts, int level) {
  const std::vector<Document> parts = parts_of(scene, 3);
  Document words, methods;
  for (const auto& block : parts.front())
    (std::holds_alternative<Table>(block) ? methods : words).push_back(block);
  std::string text = html_of(words, level) + figures_of(charts) + to_unfold("Methods", methods, level + 1);
  for (std::size_t i = 1; i < parts.size(); ++i)
    text += to_unfold(heading_of(parts[i]), Document(parts[i].begin() + 1, parts[i].end()), level + 1);
  return text;
}

std::string guide_of(const FoundGuide& guide, const std::string& id, int level) {
  std::vector<Document> parts = parts_of(guide.page, 2);
  // The title is the section's.
  std::erase_if(parts.front(), [](const auto& block) { return std::holds_alternative<Heading>(block); });
  std::string text = html_of(parts.front(), level);
  const std::vector<std::string> scenes = guide.scenes();
  for (const std::string& scene : scenes)
    if (std::none_of(parts.begin() + 1, parts.end(),
                     [&](const Document& part) { return is_about(part, scene); }))
      parts.push_back({Heading{2, scene}});
  for (std::size_t i = 1; i < parts.size(); ++i) {
    const auto scene =
        std::ranges::find_if(scenes, [&](const std::string& name) { return is_about(parts[i], name); });
    std::vector<Chart> charts;
    if (scene != scenes.end())
      charts = guide_charts(guide, *scene, id + "-guide-" + std::to_string(scene - scenes.begin() + 1));
    text += guide_of_scene(parts[i], charts, level);
  }
  return text;
}

}  // namespace

std::string guide_section(const ReportInput& input) {
  const int level = input.folders.size() < 2 ? 3 : 4;
  return of_each_folder(input, "", [&](const ReportFolder& folder, const std::string& id) {
    return folder.guide ? guide_of(*folder.guide, id, level) : std::string();
  });
}

std::string roofline_section(const ReportInput& input) {
  return "<p>Operations and bytes are what a step needs at least. Roofs are what the timings say of the "
         "machine's "
         "peaks, measured in the same process.</p>\n" +
         of_each_folder(input, "<p>No folder has rows with a roofline; garments have none.</p>\n",
                        [&](const ReportFolder& folder, const std::string& id) {
                          const auto chart = roofline_chart(folder.rows, id);
                          return chart ? figures_of({*chart}) : std::string();
                        });
}

namespace {

std::string energies_of(const std::vector<FoundCurve>& curves, std::span<const FoundCurve> references,
                        const std::string& id) {
  std::vector<Chart> charts;
  std::vector<std::string> without;
  for (const FoundCurve& curve : curves) {
    charts.push_back(energy_chart(curve, references, id + "-energy-" + std::to_string(charts.size())));
    if (!reference_of(curve, references)) without.push_back(curve.name);
  }
  std::string text = figures_of(charts);
  if (!without.empty()) text += "<p>Without a reference curve: " + html_text(join(without, ", ")) + ".</p>\n";
  return text;
}

}  // namespace

std::string energy_section(const ReportInput& input) {
  const std::string simulated = input.curves.empty()
                                    ? ""
                                    : "<p>Simulated anew for this page, beside a reference in double "
                                      "precision with steps of rk4.</p>\n" +
                                          energies_of(input.curves, input.references, "simulated");
  return simulated +
         of_each_folder(input,
                        simulated.empty()
                            ? "<p>No folder has an energy curve. <code>mssim run --scene cloth2500 "
                              "--energy-curve FOLDER/cloth2500.csv</code> "
                              "writes one into a folder.</p>\n"
                            : "",
                        [&](const ReportFolder& folder, const std::string& id) {
                          return energies_of(folder.curves, input.references, id);
                        });
}

std::string picture_section(const ReportInput& input) {
  const std::string drawn =
      input.pictures.empty()
          ? ""
          : "<p>A scene of each kind, simulated anew for this page by <code>openmp</code>.</p>\n" +
                pictures_of(input.pictures);
  return drawn +
         of_each_folder(
             input,
             drawn.empty() ? "<p>No folder has a picture. <code>mssim render</code> draws one; put it "
                             "into a folder as a PNG file.</p>\n"
                           : "",
             [](const ReportFolder& folder, const std::string&) { return pictures_of(folder.pictures); });
}

}  // namespace mssim
