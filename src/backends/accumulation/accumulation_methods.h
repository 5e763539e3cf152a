#pragma once

#include <span>
#include <string_view>

#include "backends/backends.h"

namespace mssim {

/// When the results of a method are bitwise identical.
enum class Repeatable { never, at_same_threads, always };

/// The word for tables.
std::string_view name_of(Repeatable repeatable);

/// A row of the TABLE of methods against the data race of Hong et al.'s Figure 1: threads concurrently add
/// the forces of springs to the nodes that they share.
struct AccumulationMethod {
  BackendInfo backend;
  std::string_view extra_memory;      ///< in addition to `serial`'s
  std::string_view springs_computed;  ///< in each stage
  Repeatable repeatable;
};

/// The TABLE, in the order of all listings and results. `serial`, which has no race, is the base of the
/// ratios; `openmp` shows the effect of another layout, and `gather-vectors` before it the effect of
/// computing each spring of a cloth once. The others differ from `serial` only in the accumulation. These are
/// not backends of `mssim run`; they exist only for comparison.
std::span<const AccumulationMethod> accumulation_methods();

}  // namespace mssim
