#include "charts/draw_svg.h"

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "charts/chart_layout.h"
#include "charts/chart_text.h"
#include "charts/gnuplot_script.h"
#include "charts/page_svg.h"
#include "charts/plotted_values.h"
#include "platform/files.h"
#include "platform/process.h"
#include "text/text.h"

namespace mssim {
namespace {

namespace fs = std::filesystem;

/// A chart takes 0.02 s; what takes this long never ends.
constexpr unsigned most_cpu_seconds = 20, most_elapsed_seconds = 120;
/// Charts have some ten kilobytes, and gnuplot draws them in less than 0.3 GB.
constexpr std::uint64_t most_svg_bytes = std::uint64_t{64} << 20, most_memory_bytes = std::uint64_t{2} << 30;

void require_id(const std::string& id) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const auto is_more = [&](char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '-'; };
  if (id.empty() || !is_letter(id.front()) || !std::ranges::all_of(id, is_more))
    throw std::invalid_argument("the id \"" + printable(id) +
                                "\" of a chart is not letters, digits and hyphens");
}

std::string axis_words(const Axis& axis) { return axis.label + (axis.logarithmic ? " (logarithmic)" : ""); }

ChartWords words_of(const Chart& chart, const std::vector<std::string>& notes) {
  constexpr std::size_t most = 4000;
  std::vector<std::string> names;
  for (const Series& series : chart.series) names.push_back(series.name);
  std::string description = "Along: " + axis_words(chart.x) + ". Upwards: " + axis_words(chart.y) +
                            ". Series: " + join(names, ", ") + '.';
  for (const std::string& note : notes) description += ' ' + note + '.';
  return {chart.id, shown_text(chart.title, most), shown_text(description, most)};
}

std::string how_it_ended(const ChildResult& ended) {
  if (ended.out_of_time)
    return "was stopped after " + std::to_string(most_cpu_seconds) + " s of processor time or " +
           std::to_string(most_elapsed_seconds) + " s in all";
  if (ended.out_of_memory || ended.signal == SIGKILL) return "was stopped for lack of memory";
  if (ended.signal != 0) return "ended with signal " + std::to_string(ended.signal);
  if (ended.exit_code != 0) return "ended with exit code " + std::to_string(ended.exit_code);
  return "ended without a complete chart";
}

/// The last line, which says what is wrong; those before it repeat the script.
std::string last_words(const std::string& output) {
  std::istringstream lines(output);
  std::string last;
  for (std::string line; std::getline(lines, line);)
    if (line.find_first_not_of(" \t\r") != std::string::npos) last = line;
  return last.empty() ? last : " and wrote \"" + printable(last, 200) + '"';
}

}  // namespace

DrawnChart draw_svg(const Chart& chart) {
  require_id(chart.id);
  const PlottedValues values = plotted_values(chart);
  DrawnChart drawn{{}, {}, chart.remarks};
  drawn.notes.insert(drawn.notes.end(), values.notes.begin(), values.notes.end());
  const auto without = [&](std::string problem) {
    drawn.problem = std::move(problem);
    return drawn;
  };
  if (values.empty()) return without("there is no value to draw");
  const auto gnuplot = find_program("gnuplot");
  if (!gnuplot)
    return without(
        "the program gnuplot, which draws charts, is not in PATH; install Debian's package gnuplot-nox");

  const TemporaryFolder folder;
  const fs::path script = folder.path() / "chart.gp", output = folder.path() / "chart.svg";
  std::ofstream file(script, std::ios::binary);
  file << gnuplot_script(chart, values, chart_layout(chart, values), output.filename().string());
  file.close();
  if (!file)
    return without("cannot write " + script.string() + "; make room in the folder of temporary files");
  // Without the user's own settings, and with a point in numbers.
  const ChildResult ended = run({*gnuplot,
                                 {"--default-settings", script.filename().string()},
                                 {"LC_ALL=C"},
                                 folder.path(),
                                 most_cpu_seconds,
                                 most_elapsed_seconds,
                                 most_memory_bytes,
                                 most_svg_bytes});
  const bool well = ended.signal == 0 && ended.exit_code == 0 && fs::is_regular_file(output) &&
                    fs::file_size(output) <= most_svg_bytes;
  if (const auto svg = well ? page_svg(read_file(output), words_of(chart, drawn.notes)) : std::nullopt)
    drawn.svg = *svg;
  else
    drawn.problem = gnuplot->string() + ' ' + how_it_ended(ended) + last_words(ended.output);
  return drawn;
}

}  // namespace mssim
