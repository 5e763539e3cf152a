#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "backends/backends.h"
#include "backends/interface/backend.h"
#include "output/tables/results.h"
#include "output/tables/suite_tables.h"

namespace mssim {

/// The backends and integrators compared on a scene, and the tables of their times.
struct Comparison {
  std::vector<const BackendInfo*> (*backends)();  ///< the rows of a table, in its order
  std::span<const std::string_view> integrators;  ///< by default
  TableMaker (*tables)();                         ///< called before any measurement
  bool described_too = false;                     ///< by default, also all described backends
  /// Names of additional backends that come with mssim as programs; null: none.
  std::vector<std::string> (*programs)(const ExecutionOptions& execution) = nullptr;
  /// Whether a backend is measured on a scene; null: all on all.
  bool (*is_compared)(std::string_view scene, std::string_view backend) = nullptr;
  int threads = 0;  ///< by default; 0: one per CPU
};

/// A row of the TABLE of suites: scenes and their comparison.
struct Suite {
  std::string_view name;
  std::string_view description;  ///< one line for `mssim list suites`
  bool in_tables;                ///< whether "tables" includes it: those of Hong et al.
  bool timed;                    ///< else nothing is measured, and the table describes the scenes
  std::span<const std::string_view> scenes;
  Comparison comparison;
  /// Variants (BackendChoice::require) to measure in addition if the user names neither backends nor threads.
  std::span<const std::string_view> variants = {};
};

/// The suite that `mssim guide` measures, with its own kind of table.
inline constexpr std::string_view guide_suite = "guide";

/// The TABLE of suites, in the order of listings.
std::span<const Suite> suites();

/// The papers' names from the tables of backends, integrators and suites.
PaperLegend paper_legend();

/// The scenes, each once, of the suite `name`, or of all suites in "tables": of timed suites, or of the
/// others.
std::vector<std::string> scenes_of_suite(std::string_view name, bool timed);

/// The variants, each once, of the suite `name`, or of all suites in "tables", that have the scene.
std::vector<std::string_view> variants_of_suite(std::string_view name, std::string_view scene);

/// The comparison of the suite `name`. For "tables" and an empty name, it is that of `bench`'s default
/// backends.
const Comparison& comparison_of_suite(std::string_view name);

}  // namespace mssim
