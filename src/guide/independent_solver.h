#pragma once

#include <functional>
#include <optional>

#include "model/system.h"

namespace mssim {

/// The state of a system `span_s` after its start, in double precision, by a solver that shares nothing with
/// the table of integrators but the laws of springs and acceleration: Boost.Odeint's Bulirsch-Stoer method
/// (extrapolated modified midpoint rules of variable order and step; Hairer, Norsett and Wanner, Solving
/// Ordinary Differential Equations I, section II.9). `tolerance`: the error of a step, absolute, of
/// positions in m and velocities in m/s. The floor does not act. None where `stop` ended it
/// between two of its steps, or where it found no step that is small enough.
std::optional<State> independent_state(const System& system, double span_s, double tolerance,
                                       const std::function<bool()>& stop);

}  // namespace mssim
