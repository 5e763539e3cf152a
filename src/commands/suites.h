#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace mssim {

/// A row of the TABLE of suites: the scenes behind a table of a paper.
struct Suite {
  std::string_view name;
  bool timed;  ///< else the table says what the scenes are, and nothing is measured
  std::span<const std::string_view> scenes;
};

std::span<const Suite> suites();

/// The names of the suites, and "all".
std::vector<std::string> suite_names();

/// The scenes of the suites of that name whose tables are timed or not, each once. "all" stands for every
/// suite.
std::vector<std::string> scenes_of_suite(std::string_view name, bool timed);

}  // namespace mssim
