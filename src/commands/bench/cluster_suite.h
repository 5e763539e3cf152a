#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "backends/interface/backend.h"

namespace mssim {

/// The scenes of `--suite cluster`: cloths and bodies that ever more processes share (strong scaling), and
/// cloths that are wider the more processes there are, NAME-xN (weak scaling).
inline constexpr std::array<std::string_view, 10> cluster_scenes{
    "cloth350k",   "cloth350k-x2", "cloth350k-x4", "cloth350k-x8", "cloth10k",
    "cloth10k-x2", "cloth10k-x4",  "cloth10k-x8",  "cloth4m",      "bodies38233"};

/// mpi in 1, 2, 4, ... processes up to --ranks, or else up to one for every processor and at least four; and
/// as many copies that say nothing to each other.
std::vector<std::string> cluster_programs(const ExecutionOptions& execution);

/// A cloth N times as wide is for N processes, and for no other backend.
bool is_in_cluster(std::string_view scene, std::string_view backend);

}  // namespace mssim
