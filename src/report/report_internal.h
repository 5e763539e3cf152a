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

/// What a page is made of: comparisons of measured with published times, the sentences that follow from them,
/// charts, and HTML.

/// The exponent p of y ~ x^p: the slope of the line of least squares on logarithmic axes. None for fewer than
/// two different x. All are above zero.
std::optional<double> exponent_of(std::span<const double> x, std::span<const double> y);

/// A published table and the rows that were measured of its scenes: what verdicts and charts ask of both.
class PaperScenes {
 public:
  /// All must outlive it.
  PaperScenes(std::span<const ResultRow> rows, const PaperLegend& legend, const PublishedTable& published);

  const std::vector<PaperScene>& scenes() const { return scenes_; }  ///< by size
  const PaperLegend& legend() const { return legend_; }
  std::span<const ResultRow> rows() const { return rows_; }
  /// Over one thread; none where either time is missing.
  std::optional<double> published_speedup(const PaperScene& scene, std::string_view integrator,
                                          std::string_view configuration) const;
  /// Null where there is none.
  const ResultRow* row(const PaperScene& scene, std::string_view backend, std::string_view integrator) const;
  /// The backends that stand for a configuration and have a time.
  std::vector<std::string> backends_of(std::string_view configuration) const;

 private:
  std::span<const ResultRow> rows_;
  const PaperLegend& legend_;
  const PublishedTable& published_;
  std::vector<PaperScene> scenes_;
};

/// What rows say of a claim.
enum class ClaimOutcome : std::uint8_t {
  held,
  not_held,      ///< a ratio lies below what the claim needs, with its whole interval
  undecided,     ///< intervals contain what the claim needs
  not_testable,  ///< what it needs is missing here
};

std::string_view name_of(ClaimOutcome outcome);

struct JudgedClaim {
  const Claim* claim = nullptr;
  ClaimOutcome outcome = ClaimOutcome::not_testable;
  std::string published{};  ///< the published ratios; empty where the paper gives none
  std::string measured{};   ///< the measured ratios, or what is missing
};

/// What the rows of a folder say of the claims about its scenes, those first that they decide. Claims that no
/// rows decide are with any scene of their paper.
std::vector<JudgedClaim> judge(const ReportFolder& folder, const ReportInput& input);

/// A sentence about rows, computed. With the marks of a Document.
struct Finding {
  bool is_warning = false;
  std::string sentence;
};

/// On which devices rows were measured, which are not verified or have no time, and which speed-ups cannot be
/// told from 1. None without rows.
std::vector<Finding> row_findings(std::span<const ResultRow> rows, const Provenance& provenance);

/// What a page calls a backend that ran on a device of OpenCL ("" for none): "opencl on the CPU", "opencl,
/// DEVICE". `family` decides its look in charts: OpenCL on a GPU shares that of the published GPU, and OpenCL
/// on the processor has one of its own.
struct BackendLook {
  std::string name, family;
};
BackendLook look_on(std::string_view device, std::string_view backend, const Provenance& provenance);

/// The same of the backend of rows, by the device that they ran on.
BackendLook look_of(std::span<const ResultRow> rows, std::string_view backend, const Provenance& provenance);

/// Does the backend stand for a configuration of the paper with a GPU?
bool is_for_gpus(std::string_view backend, const PaperLegend& legend);

/// The families that look the same in every chart which has no others.
std::vector<std::string> families_of_backends(const PaperLegend& legend);

/// "Measured on PROCESSOR, N threads"; empty where the provenance does not tell.
std::string where_measured(const Provenance& provenance, bool with_threads = true);

/// Charts. `id` begins their ids, so that those of several folders differ. A chart without anything to show
/// is none. Each says on which processor it was measured, as far as the provenance tells.

/// For each integrator of the paper: speed-ups over one thread against nodes, published and measured.
std::vector<Chart> speedup_charts(const PaperScenes& scenes, const Provenance& provenance,
                                  const std::string& id);

/// Figure 6 of Vassilev: milliseconds per iteration against vertices, of garments.
std::optional<Chart> figure6_chart(std::span<const ResultRow> rows, const Provenance& provenance,
                                   const std::string& id);

/// The time per step of the first integrator against nodes, for each kind of scene with at least two sizes,
/// with the slope of every line.
std::vector<Chart> scaling_charts(std::span<const ResultRow> rows, const PaperLegend& legend,
                                  std::span<const PublishedTable> published, const Provenance& provenance,
                                  const std::string& id);

/// For each scene how many times as fast as on the fewest threads the rows with the first integrator are,
/// against threads.
std::vector<Chart> thread_charts(std::span<const ResultRow> rows, const Provenance& provenance,
                                 const std::string& id);

/// The slopes of all integrators: exponents p of time ~ nodes^p. Without rows where nothing has two sizes.
Table slope_table(std::span<const ResultRow> rows, const PaperLegend& legend,
                  std::span<const PublishedTable> published);

/// A dot a backend, on the largest scene that has a roofline, with the first integrator, below the roofs that
/// the timings tell of.
std::optional<Chart> roofline_chart(std::span<const ResultRow> rows, const Provenance& provenance,
                                    const std::string& id);

/// Total energy against time, with the reference curve of the scene that the curve's name begins with, where
/// there is one.
Chart energy_chart(const FoundCurve& curve, std::span<const FoundCurve> references, const std::string& id);

/// The charts of a scene of a guide: work and precision (Hairer, Norsett and Wanner, Solving Ordinary
/// Differential Equations I, section II.10), errors over steps and over force evaluations, and times by size.
/// A line is an integrator; each of its points is that of the cheapest backend with this step. Diverged
/// points stand as crosses at the edge, whatever their error.
std::vector<Chart> guide_charts(const FoundGuide& guide, const PaperLegend& legend,
                                const Provenance& provenance, const std::string& scene,
                                const std::string& id);

/// The values of a chart that has one place, as a table, which shows them better. References, which only help
/// to read a chart, are left out.
Table values_of(const Chart& chart);
/// Whether it is a chart of lines over whole numbers, such as nodes, with all values at one of them.
bool has_one_place(const Chart& chart);

/// Any text (a file's name, a scene's, a message) as HTML shows it, in elements and in quoted attributes. The
/// one place that escapes: all that stands in a page went through it, or is written in the program.
std::string html_text(std::string_view text);

/// HTML of a text with the marks of a Document (`code`, *emphasis*, **strong**, line feeds). A mark that
/// is not closed, or has a blank behind it, stands for itself.
std::string html_prose(std::string_view text);

/// A table in a box of its own, in which it scrolls where the page is narrower. The first column names the
/// rows.
std::string html_of(const Table& table);

/// Blocks one below the other; the first level of its headings becomes `level`.
std::string html_of(const Document& document, int level);

/// Raw data for programs, in an element that no browser runs or shows. `json` is JSON.
std::string html_data(std::string_view id, std::string_view json);

/// A part of the page under a heading of its own.
struct PageSection {
  std::string_view id, title;
  /// Its HTML, which says so where there is nothing to show; empty: the section is left out.
  std::string (*content)(const ReportInput& input);
  bool of_rows = true;  ///< it shows what mssim bench has measured: left out where all folders are guides
};

/// In the order in which they stand.
std::span<const PageSection> report_sections();

}  // namespace mssim
