#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/machine/provenance.h"
#include "bench/results/history.h"
#include "bench/results/result.h"
#include "output/tables/results.h"
#include "output/tables/suite_tables.h"
#include "output/tables/table.h"
#include "platform/files.h"

namespace mssim {

/// One HTML page about result folders: read_report_folder() reads each, even if damaged, and report_page()
/// makes the page.

/// A row of guide.csv (docs/guide.md): cost and error of one step size or, without a step, why a method has
/// no points.
struct GuidePoint {
  std::string scene{}, integrator{}, backend{};
  std::optional<double> dt_s{};
  std::optional<double> position_error{};  ///< in mean rest lengths; none if not finite
  std::optional<double> wall_s_per_s{}, force_evaluations_per_s{};
  bool diverged = false, on_front = false;
  /// "ok" if the point may be compared. Otherwise it diverged, its error is too close to that of the
  /// reference, or its step is longer than the largest stable one.
  std::string status{};
};

/// A row of guide-sizes.csv.
struct GuideTime {
  std::string scene, integrator, backend;
  double nodes = 0, ms_per_step = 0;
};

/// The results of `mssim guide` in a folder.
struct FoundGuide {
  std::vector<GuidePoint> points;
  std::vector<GuideTime> times;
  Document page;  ///< guide.md

  /// The scenes in order of appearance.
  std::vector<std::string> scenes() const;
};

/// An energy curve in a result folder (output/traces/energy_curve.h).
struct FoundCurve {
  std::string name;  ///< of the file, without .csv
  std::vector<double> time_s, total_j;
};

/// A PNG picture in a result folder, or one drawn for the report.
struct FoundPicture {
  std::string caption;
  std::string png;  ///< bytes
};

/// Everything that a report shows of a result folder. Missing or damaged parts become sentences, never
/// errors.
struct ReportFolder {
  std::string name;                  ///< as given
  std::vector<ResultRow> rows;       ///< the readable ones; without any samples if those are damaged
  std::optional<FoundGuide> guide;   ///< of a folder that mssim guide wrote
  std::vector<StructureRow> bodies;  ///< of table2.csv
  std::optional<Provenance> provenance;
  std::vector<FoundCurve> curves;
  std::vector<FoundPicture> pictures;
  std::vector<std::string> tables;    ///< those of table_names that lie in it
  std::vector<std::string> problems;  ///< without a full stop

  /// The provenance; empty if unknown.
  Provenance where_from() const { return provenance.value_or(Provenance()); }
};

/// The folder itself if it has a timings.csv, a guide.csv or a table2.csv; otherwise its subfolders that have
/// one, by name.
std::vector<std::filesystem::path> result_folders(const std::filesystem::path& folder);

/// Reads what a folder has. Throws LaterFormatError for a folder that a later mssim wrote.
ReportFolder read_report_folder(const std::filesystem::path& path);

/// Parses an energy curve, which may begin with comment lines; none if the text is another table. Throws
/// CsvError if it is damaged.
std::optional<FoundCurve> energy_curve_in(const std::string& name, std::string_view text);

/// Kind of a scene; scenes of the same kind are on one line of a chart.
enum class ContentKind : std::uint8_t { cloth, bodies, garment, other };
ContentKind kind_of(const ResultRow& row);

/// How rows decide a claim: the ratio of two backends' times on the scenes of a table.
struct ClaimTest {
  std::string scenes;                    ///< name of the published table; figure6: all shipped garments
  std::string fast, slow;                ///< backends
  std::vector<std::string> integrators;  ///< empty: the paper's
  std::string slow_integrator;           ///< of `slow`; empty: that of `fast`
  /// If not empty: the ratio is the speed-up with each integrator divided by that with this one.
  std::string gains_more_than;
  bool on_gpu = false;      ///< rows of OpenCL on this CPU decide nothing
  bool of_average = false;  ///< test the geometric mean of the ratios instead of each
  double at_least = 1;      ///< the ratio that must be exceeded
};

/// A statement of a paper that a measurement can support or contradict.
struct Claim {
  std::string name, paper, place;
  std::string says;               ///< paraphrased in one line
  std::string needs;              ///< what a decision needs besides rows; may be empty with a test
  std::optional<ClaimTest> test;  ///< none if no rows can decide it
};

/// The claims of published/claims.json in the data folder (in the repository, results/published). Throws
/// SceneError if the file is invalid, and std::runtime_error if the folder or the file is missing.
std::vector<Claim> published_claims();

/// Parses the claims in the text of a file. Throws SceneError.
std::vector<Claim> claims_in(const std::filesystem::path& file, const std::string& text);

/// The JSON Schema of that file.
std::string claims_schema();

/// Input of a report.
struct ReportInput {
  std::vector<ReportFolder> folders;
  PaperLegend legend;
  std::vector<PublishedTable> published;
  std::vector<Claim> claims;           ///< of the papers
  TableMaker tables;                   ///< of the rows of a folder
  std::vector<FoundCurve> references;  ///< energy curves, named after their scenes
  std::vector<FoundPicture> pictures;  ///< of scenes of the folders, drawn for the report
  std::vector<FoundCurve> curves;      ///< of energy, of scenes simulated for the report
  std::vector<HistoryEntry> history;   ///< times of commits; may be empty
  double threshold = 0.05;             ///< smallest change that matters between two folders or commits
  std::vector<std::string> problems;   ///< not of any folder; without a full stop
  std::string made_by;                 ///< the program and its version
};

/// A self-contained page: no network, no script, no other file. The element "mssim-data" has the data as
/// JSON: {made_by, folders: [{name, problems, claims: [{name, outcome, published, measured}], findings:
/// [{is_warning, sentence}], timings: [a row of timings.csv], provenance: as in provenance.json, or null}]};
/// folders of guides also have guide: [a row of guide.csv, with the columns that charts show]. A history is
/// history: [a line of its file].
std::string report_page(const ReportInput& input);

/// A page with tables about a folder.
struct TablePage {
  std::string name;    ///< letters, digits and hyphens
  Document page;       ///< its title, where it was measured, and what more there is
  std::string remark;  ///< for captions: how many rounds; empty for a guide's
};

/// The tables that lie in the folder, made anew from its rows, and the page of its guide; then `times`, all
/// rows with their intervals. Throws InputError for a folder without provenance.
std::vector<TablePage> table_pages(const ReportFolder& folder, const ReportInput& input);

/// What a LaTeX paper about the folders needs: for each folder its table_pages() as NAME.tex, its charts as
/// SVG and figures.tex, which includes them as PDF, methods.tex and artifact.tex; sources.bib, and mssim.tex,
/// a document of all of them. If there are several folders, names begin with that of the folder. Throws
/// like table_pages(), and std::runtime_error if the data folder is missing.
std::vector<FolderFile> paper_files(const ReportInput& input);

}  // namespace mssim
