#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bench/machine/provenance.h"
#include "bench/results/result.h"
#include "report/guide_folder.h"

namespace mssim {

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
};

/// The result folders that a folder stands for: itself where it has a timings.csv or a guide.csv; else its
/// subfolders that have one, by name; none where none has.
std::vector<std::filesystem::path> result_folders(const std::filesystem::path& folder);

ReportFolder read_report_folder(const std::filesystem::path& path);

/// An energy curve of a text; none where it is no such curve. `text` may begin with lines of comment.
std::optional<FoundCurve> energy_curve_in(const std::string& name, std::string_view text);

/// Pictures beyond this size are not taken into a page.
inline constexpr std::size_t largest_picture_bytes = std::size_t{8} << 20;

}  // namespace mssim
