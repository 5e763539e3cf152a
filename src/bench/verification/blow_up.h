#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "backends/interface/backend.h"

namespace mssim {

/// Where a simulation left the numbers: the first step whose result is not finite in single precision, in
/// which most backends compute and traces store, and the first such node. Energies of what is finite in it
/// are finite in double precision.
struct BlowUp {
  int step = 0;  ///< counted from 1
  std::size_t node = 0;
};

/// What is said where steps blow up, and do not when they are taken again.
inline constexpr std::string_view finite_in_the_next =
    "not finite in one run, finite in the next: a data race";

/// The first node whose position or velocity is not finite in single precision.
std::optional<std::size_t> first_bad_node(const State& state);

/// Finds the first bad step of a simulation that was found bad `steps` steps after `from`, by bisection: a
/// number that is not finite stays so. Leaves the backend in any state. Empty if the simulation is good after
/// all.
std::optional<BlowUp> find_blow_up(Backend& backend, const State& from, int steps);

/// The same by any way to find the first bad node so many steps after the start.
std::optional<BlowUp> find_blow_up(const std::function<std::optional<std::size_t>(int steps)>& bad_node_after,
                                   int steps);

/// "blew up at step 12 (t = 0.0012 s): node 34 is not finite; ..." with the remedy. `steps_before` were taken
/// before.
std::string describe(const BlowUp& blow_up, double dt_s, std::int64_t steps_before = 0);

}  // namespace mssim
