#pragma once

#include <span>
#include <string_view>

#include "backends/backends.h"

namespace mssim {

/// When a method gives the same bits again.
enum class Repeatable { never, at_same_threads, always };

/// In words, for tables.
std::string_view name_of(Repeatable repeatable);

/// A row of the TABLE of methods to avoid the data race of Hong et al.'s Figure 1: springs that threads
/// process at the same time add to the forces of nodes that they share.
struct AccumulationMethod {
  BackendInfo backend;
  std::string_view extra_memory;      ///< besides what `serial` holds
  std::string_view springs_computed;  ///< how often in each stage
  Repeatable repeatable;
};

/// The TABLE, in the order of every listing and result: `serial`, which has no race, is the base of the
/// ratios, and `openmp` what comes out when the layout is changed too, with `gather-vectors` before it to
/// show what computing each spring of a cloth once is worth there. The others differ from `serial` in the
/// accumulation alone. These are no backends of `mssim run`: they exist to be compared.
std::span<const AccumulationMethod> accumulation_methods();

}  // namespace mssim
