#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "output/tables/table.h"

namespace mssim {

/// A row of guide.csv (docs/guide.md): what a step of one size costs and how far off it ends; or, without a
/// step, why a method has no points.
struct GuidePoint {
  std::string scene{}, integrator{}, backend{};
  std::optional<double> dt_s{};
  std::optional<double> position_error{};  ///< in mean rest lengths; none where not finite
  std::optional<double> wall_s_per_s{}, force_evaluations_per_s{};
  bool diverged = false, on_front = false;
  std::string status{};
};

/// What stands in a point's status where conclusions may rest on it. Else it diverged, is too near the error
/// of the reference, or has a longer step than the largest stable one.
inline constexpr const char* compared_status = "ok";

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

/// Its table of points, which says that a folder is a guide's.
inline constexpr const char* guide_name = "guide.csv";

/// None where the folder has no guide.csv. Adds to `problems` what is missing or damaged, without a full
/// stop.
std::optional<FoundGuide> read_guide(const std::filesystem::path& folder, std::vector<std::string>& problems);

}  // namespace mssim
