#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "backends/backends.h"
#include "backends/interface/backend.h"
#include "output/tables/results.h"
#include "output/tables/suite_tables.h"

namespace mssim {

/// What is compared on a scene, and which tables are made of the times.
struct Comparison {
  std::vector<const BackendInfo*> (*backends)();  ///< the rows of a table, in its order
  std::span<const std::string_view> integrators;  ///< by default
  TableMaker (*tables)();                         ///< reads what it needs at once, so before any measurement
  bool described_too = false;                     ///< by default, all backends that are described, too
  /// The names of further backends that come with mssim as programs; null: none.
  std::vector<std::string> (*programs)(const ExecutionOptions& execution) = nullptr;
  /// Whether a backend is measured on a scene; null: each on all.
  bool (*is_compared)(std::string_view scene, std::string_view backend) = nullptr;
  int threads = 0;  ///< by default; 0: one for every processor
};

/// A row of the TABLE of suites: scenes, and what is compared on them.
struct Suite {
  std::string_view name;
  std::string_view description;  ///< one line for `mssim list suites`
  bool in_tables;                ///< whether "tables" stands for it too: those of Hong et al.
  bool timed;                    ///< else the table says what the scenes are, and nothing is measured
  std::span<const std::string_view> scenes;
  Comparison comparison;
  /// Variants (BackendChoice::require) that its scenes are also measured with, where the user names neither
  /// backends nor threads.
  std::span<const std::string_view> variants = {};
};

/// The suite whose scenes `mssim guide` measures, in a table of its own kind.
inline constexpr std::string_view guide_suite = "guide";

std::span<const Suite> suites();

/// What the tables of backends, integrators and suites say about the papers.
PaperLegend paper_legend();

/// The names of the suites, and "tables".
std::vector<std::string> suite_names();

/// The scenes of the suites of that name whose tables are timed or not, each once. "tables" stands
/// for the suites that are in it.
std::vector<std::string> scenes_of_suite(std::string_view name, bool timed);

/// The variants of the suites of that name, each once; with a scene, of those that have it.
std::vector<std::string_view> variants_of_suite(std::string_view name,
                                                std::optional<std::string_view> scene = std::nullopt);

/// What the suite of that name compares. "tables", and no suite (an empty name), compare the backends that
/// `bench` takes by default.
const Comparison& comparison_of_suite(std::string_view name);

}  // namespace mssim
