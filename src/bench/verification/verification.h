#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "backends/interface/backend.h"
#include "model/energy.h"

namespace mssim {

/// What the double-precision reference reached: the yardstick for every backend of a scene and integrator.
struct Reference {
  int steps = 0;  ///< taken from the start; before any node touches the floor, and comparable
  State state;
  Energy energy;
  double tolerance = 0;                ///< on the position error, in mean rest lengths
  std::optional<std::string> failure;  ///< why there is no reference
};

/// Steps of a verification run: enough for a wrong force to show, few enough that rounding does not.
inline constexpr int verification_steps = 100;

/// Largest allowed difference of total energy, as a share of the energy in motion (energy_in_motion).
inline constexpr double energy_tolerance = 0.01;

/// Stages of a step that write the new position, and round it.
int position_roundings(const Integrator& integrator);

/// Steps from the start until a rounding may have doubled, at least 1 and at most `most`: beyond, a tolerance
/// for roundings alone says nothing. From what the integrator multiplies the modes of the system by
/// (stability.h), which lie between those of its spectrum; all that are asked for where it is stable.
int comparable_steps(const System& system, const Integrator& integrator, double dt_s, int most);

/// Largest position error, in mean rest lengths, that single precision may cause in `steps` steps.
///
/// A stage that writes the new position rounds it by at most u = 2^-24 of its magnitude. Independent
/// roundings add up like a random walk, to the square root of their number, and that is what float backends
/// show: over 100 steps of all cloths the methods with one such stage end 8 to 12 u |x| away from the
/// reference, RK4 with four of them 24 to 53. Allowed are four times the square root. An implicit step writes
/// the position once; xpbd's small steps write it more often, but carry on what each sum loses.
/// tests/bench/verification/verification_test.cpp proves that a missing spring or pin, or one kind of spring
/// 1 % too stiff, exceeds it.
double position_tolerance(const System& system, const Integrator& integrator, int steps);

/// Why there is no reference where a node touches the floor within the first steps.
std::string touches_at_once(int steps);

/// Runs the reference. Its state is taken, at a multiple of ten steps or at the last of comparable_steps,
/// before any node touches the floor: after a bounce, results differ by a step's worth of landing time, and a
/// tolerance would mean nothing.
Reference run_reference(const System& system, const Integrator& integrator, double dt_s);

/// A backend's result against the reference.
struct Verification {
  double position_error = 0;  ///< largest distance between the same node's positions, in mean rest lengths
  double energy_drift =
      0;  ///< total energy less the reference's, over the reference's kinetic + elastic energy
  std::optional<std::uint64_t> state_hash;  ///< of the state after the last step (model/system.h)
  std::optional<std::string> failure;       ///< empty: verified
};

/// Steps the backend from the start and compares. Leaves the backend in any state.
Verification verify(Backend& backend, const System& system, const Reference& reference, double dt_s);

}  // namespace mssim
