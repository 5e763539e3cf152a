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

namespace mssim {

/// One HTML page about result folders: read_report_folder() reads each whatever is damaged, report_page()
/// makes the page of them.

/// A row of guide.csv (docs/guide.md): what a step of one size costs and how far off it ends; or, without a
/// step, why a method has no points.
struct GuidePoint {
  std::string scene{}, integrator{}, backend{};
  std::optional<double> dt_s{};
  std::optional<double> position_error{};  ///< in mean rest lengths; none where not finite
  std::optional<double> wall_s_per_s{}, force_evaluations_per_s{};
  bool diverged = false, on_front = false;
  /// "ok" where conclusions may rest on it. Else it diverged, is too near the error of the reference, or has
  /// a longer step than the largest stable one.
  std::string status{};
};

/// A row of guide-sizes.csv.
struct GuideTime {
  std::string scene, integrator, backend;
  double nodes = 0, ms_per_step = 0;
};

/// What `mssim guide` left in a folder.
struct FoundGuide {
  std::vector<GuidePoint> points;
  std::vector<GuideTime> times;
  Document page;  ///< guide.md

  /// In the order in which they appear.
  std::vector<std::string> scenes() const;
};

/// An energy curve that lies in a result folder (output/traces/energy_curve.h).
struct FoundCurve {
  std::string name;  ///< of its file, without .csv
  std::vector<double> time_s, total_j;
};

/// A PNG picture that lies in a result folder, or that was drawn for the report.
struct FoundPicture {
  std::string caption;
  std::string png;  ///< bytes
};

/// All that a report shows of a result folder. What is missing or damaged is a sentence, never an error.
struct ReportFolder {
  std::string name;             ///< as it was given
  std::vector<ResultRow> rows;  ///< those that can be read; all have samples, or none where they are damaged
  std::optional<FoundGuide> guide;  ///< of a folder that mssim guide wrote
  std::optional<Provenance> provenance;
  std::vector<FoundCurve> curves;
  std::vector<FoundPicture> pictures;
  std::vector<std::string> problems;  ///< without a full stop

  /// An empty one where it is not known.
  Provenance where_from() const { return provenance.value_or(Provenance()); }
};

/// The result folders that a folder stands for: itself where it has a timings.csv or a guide.csv; else its
/// subfolders that have one, by name; none where none has.
std::vector<std::filesystem::path> result_folders(const std::filesystem::path& folder);

ReportFolder read_report_folder(const std::filesystem::path& path);

/// An energy curve of a text; none where it is no such curve. `text` may begin with lines of comment.
std::optional<FoundCurve> energy_curve_in(const std::string& name, std::string_view text);

/// Cloths, bodies, garments, and others: scenes of a kind lie on one line of a chart.
enum class ContentKind : std::uint8_t { cloth, bodies, garment, other };
ContentKind kind_of(const ResultRow& row);

/// How rows decide a claim: the ratio of two backends' times on the scenes of a table.
struct ClaimTest {
  std::string scenes;                    ///< name of the published table; figure6: all garments of mssim's
  std::string fast, slow;                ///< backends
  std::vector<std::string> integrators;  ///< empty: the paper's
  std::string slow_integrator;           ///< of `slow`; empty: that of `fast`
  /// Not empty: the ratio is that of two speed-ups, with each integrator and with this one.
  std::string gains_more_than;
  bool on_gpu = false;      ///< rows of OpenCL on this processor decide nothing
  bool of_average = false;  ///< the geometric mean of the ratios, else each
  double at_least = 1;      ///< how many times as fast
};

/// What a paper says that a measurement could support or contradict.
struct Claim {
  std::string name, paper, place;
  std::string says;               ///< in a line of our own
  std::string needs;              ///< what deciding it takes beside rows; may be empty where there is a test
  std::optional<ClaimTest> test;  ///< none where no rows decide it
};

/// Those of results/published/claims.json in the data folder. Throws SceneError for what is no such file, and
/// std::runtime_error when the folder is missing.
std::vector<Claim> published_claims();

/// The claims of a text, which is a file's. Throws SceneError.
std::vector<Claim> claims_in(const std::filesystem::path& file, const std::string& text);

/// The JSON Schema of that file.
std::string claims_schema();

/// All that a report is made of.
struct ReportInput {
  std::vector<ReportFolder> folders;
  PaperLegend legend;
  std::vector<PublishedTable> published;
  std::vector<Claim> claims;           ///< of the papers
  TableMaker tables;                   ///< of published beside measured numbers
  std::vector<FoundCurve> references;  ///< energy curves, named as their scenes
  std::vector<FoundPicture> pictures;  ///< of scenes of the folders, drawn for the report
  std::vector<FoundCurve> curves;      ///< of energy, of scenes simulated for the report
  std::vector<HistoryEntry> history;   ///< times of commits; may be none
  double threshold = 0.05;             ///< a change that matters between two folders or commits
  std::vector<std::string> problems;   ///< of all that is no folder, without a full stop
  std::string made_by;                 ///< the program and its version
};

/// One page that needs nothing beside it: no network, no script, no other file. Data for programs stand in it
/// as JSON, in the element "mssim-data": {made_by, folders: [{name, problems, claims: [{name, outcome,
/// published, measured}], findings: [{is_warning, sentence}],
/// timings: [a row of timings.csv], provenance: as in provenance.json, or null}]}; folders of guides have
/// guide: [a row of guide.csv, with the columns that charts show]. A history is history: [a line of its
/// file].
std::string report_page(const ReportInput& input);

}  // namespace mssim
