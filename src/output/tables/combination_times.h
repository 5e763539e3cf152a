#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace mssim {

/// What every version of mssim has written about a combination.
struct CombinationTime {
  std::string scene, backend, integrator;
  /// The least sample's time a step, of what was verified: what else a machine does only ever adds to a
  /// sample, and seldom to all of them.
  std::optional<double> least_ms;
  std::string status;  ///< why there is no time, where there is none
};

/// The rows of a timings.csv that another version of mssim may have written: columns are found by name.
/// Throws CsvError.
std::vector<CombinationTime> read_combination_times(const std::filesystem::path& file);

}  // namespace mssim
