#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "charts/chart.h"
#include "report/report.h"

namespace mssim {

/// The parts of a report page: claims, findings, charts, and HTML.

/// The exponent p of y ~ x^p by least squares on logarithmic axes; none for fewer than two different x. All
/// values must be positive.
std::optional<double> exponent_of(std::span<const double> x, std::span<const double> y);

/// Outcome of a claim, judged by rows.
enum class ClaimOutcome : std::uint8_t {
  held,
  not_held,      ///< the whole interval of a ratio is below the limit
  undecided,     ///< an interval includes the limit, or there is none
  not_testable,  ///< required rows or devices are missing
};

/// The outcome in words: "held", "not testable here".
std::string_view name_of(ClaimOutcome outcome);

/// A claim with the outcome that the rows of a folder give it.
struct JudgedClaim {
  const Claim* claim = nullptr;
  ClaimOutcome outcome = ClaimOutcome::not_testable;
  std::string published{};  ///< the published ratios; empty if the paper has none
  std::string measured{};   ///< the measured ratios, or what is missing
};

/// Judges the claims about the scenes of a folder; those that its rows decide come first. Claims that no rows
/// can decide are included if the folder has any scene of their paper.
std::vector<JudgedClaim> judge(const ReportFolder& folder, const ReportInput& input);

/// A computed sentence about rows, with the marks of a Document.
struct Finding {
  bool is_warning = false;
  std::string sentence;
};

/// Findings about devices, rows that are not verified or have no time, and speed-ups whose interval includes
/// 1 or that have none. None without rows.
std::vector<Finding> row_findings(std::span<const ResultRow> rows, const Provenance& provenance);

/// Name of a backend on an OpenCL device ("" for none): "opencl on the CPU", "opencl, DEVICE". `family`
/// decides its look in charts: OpenCL on a GPU shares that of the published GPU, OpenCL on the CPU has its
/// own.
struct BackendLook {
  std::string name, family;
};
BackendLook look_on(std::string_view device, std::string_view backend, const Provenance& provenance);

/// Whether the backend corresponds to a configuration of the paper with a GPU.
bool is_for_gpus(std::string_view backend, const PaperLegend& legend);

/// The families of the backends, which fix their looks in charts (Chart::families).
std::vector<std::string> families_of_backends(const PaperLegend& legend);

/// A sentence with the sources of noise that mssim found, without the remedies; empty if it found none. It
/// looks for them before it measures, the page of mssim web while it does.
std::string noise_of(const ReportFolder& folder);

/// The range of a count in the folder's rows, such as rounds: "15" or "7 to 15". Zeros do not count.
std::string range_of(const ReportFolder& folder, int ResultRow::*count);

/// The last two names of the folder's path: folders of several suites may have the same last name.
std::string short_name(const ReportFolder& folder);

/// Whether the page of mssim web measured the rows.
bool is_from_page(const ReportFolder& folder);

/// The table of times: one line per row. Times are the second column, so that a narrow screen shows them.
Table times_of(RowPointers rows, const ReportFolder& folder);

/// Adds the notes of rows of programs: their precision, versions and settings, each once. Nothing without
/// any.
void add_notes_of_programs(Document& page, const ReportFolder& folder);

/// Explains the columns of times_of(), with the marks of a Document.
inline constexpr std::string_view how_to_read_times =
    "*ms per step* are medians over the rounds. Intervals contain the true median in 95 % of all cases; "
    "fewer than six rounds have none. Speed-ups are over `serial`, in a browser over `javascript`: medians "
    "of the ratios within each round.";

/// "Measured on PROCESSOR, N threads"; empty if unknown.
std::string where_measured(const Provenance& provenance, bool with_threads = true);

/// Charts. `id` is the prefix of their ids, so that those of several folders differ. Charts without values
/// are left out. Each names its processor, if known.

/// For each published table and integrator of the paper: speed-ups over one thread against nodes, published
/// and measured. Then Figure 6 of Vassilev: milliseconds per iteration against vertices, of garments.
std::vector<Chart> speedup_charts(const ReportFolder& folder, const ReportInput& input,
                                  const std::string& id);

/// Time per step of the first integrator against nodes, for each kind of scene with at least two sizes, with
/// the slope of every line. Then, for each scene, the speed-up of that integrator over the fewest threads,
/// against threads.
std::vector<Chart> scaling_charts(const ReportFolder& folder, const ReportInput& input,
                                  const std::string& id);

/// The slopes of all integrators: exponents p of time ~ nodes^p. Empty if nothing has two sizes.
Table slope_table(const ReportFolder& folder, const ReportInput& input);

/// One dot per backend on the largest scene with a roofline, with the first integrator, below the roofs that
/// follow from the timings.
std::optional<Chart> roofline_chart(const ReportFolder& folder, const std::string& id);

/// Gives each backend the same look in every chart, whatever the other backends, unless the chart has its own
/// families.
std::vector<Chart> with_looks_of_backends(std::vector<Chart> charts, const PaperLegend& legend);

/// Total energy against time, with the reference curve of the scene with whose name the curve's name begins,
/// if any.
Chart energy_chart(const FoundCurve& curve, std::span<const FoundCurve> references, const std::string& id);

/// The charts of a scene of a guide: work and precision (Hairer, Norsett and Wanner, Solving Ordinary
/// Differential Equations I, section II.10), errors over steps and over force evaluations, and times by size.
/// A line is an integrator; each point is from the cheapest backend with that step. Diverged points are
/// crosses at the edge, whatever their error.
std::vector<Chart> guide_charts(const FoundGuide& guide, const PaperLegend& legend,
                                const Provenance& provenance, const std::string& scene,
                                const std::string& id);

/// For each scene and integrator of a machine's history: times per step by commit, counted from 1, with a
/// ring where a level begins.
std::vector<Chart> history_charts(const MachineHistory& machine, const std::string& id);

/// The values of a chart with has_one_place(), as a table; references are left out.
Table values_of(const Chart& chart);
/// Whether all values of a chart over whole numbers, such as nodes, are at one of them.
bool has_one_place(const Chart& chart);

/// Escapes any text (a file's name, a scene's, a message) for elements and quoted attributes. All text of a
/// page passes through it or is written in the program.
std::string html_text(std::string_view text);

/// HTML of a text with the marks of a Document (`code`, *emphasis*, **strong**, line feeds). A mark that is
/// not closed, or is followed by a blank, is plain text.
std::string html_prose(std::string_view text);

/// A table in its own box, which scrolls if the page is narrower. The first column names the rows.
std::string html_of(const Table& table);

/// The blocks from top to bottom; the first level of headings becomes `level`.
std::string html_of(const Document& document, int level);

/// JSON for programs, in an element that browsers neither run nor show.
std::string html_data(std::string_view id, std::string_view json);

/// A section of the page, with a heading.
struct PageSection {
  std::string_view id, title;
  /// Its HTML, which says so if there is nothing to show; the section is left out if it is empty.
  std::string (*content)(const ReportInput& input);
  bool of_rows = true;  ///< shows rows of mssim bench; left out if all folders are guides
};

/// The sections in their order.
std::span<const PageSection> report_sections();

}  // namespace mssim
