#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace mssim {

/// What every version of mssim has written about a combination.
struct CombinationTime {
  std::string scene, backend, integrator;
  std::optional<double> ms_per_step;  ///< of what was verified
  std::string status;                 ///< why there is no time, where there is none
};

/// The rows of a timings.csv that another version of mssim may have written: columns are found by name.
/// Throws CsvError.
std::vector<CombinationTime> read_combination_times(const std::filesystem::path& file);

}  // namespace mssim
