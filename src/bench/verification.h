#pragma once

#include <optional>
#include <string>

#include "backends/backend.h"
#include "model/energy.h"

namespace mssim {

/// What the double-precision reference reached: the yardstick for every backend of a scene and integrator.
struct Reference {
  int steps = 0;  ///< taken from the start; before any node touches the floor
  State state;
  Energy energy;
  double tolerance = 0;                ///< on the position error, in mean rest lengths
  std::optional<std::string> failure;  ///< why there is no reference
};

/// Steps of a verification run: enough for a wrong force to show, few enough that rounding does not.
inline constexpr int verification_steps = 100;

/// Largest allowed difference of total energy, as a share of kinetic plus elastic energy.
inline constexpr double energy_tolerance = 0.01;

/// Largest position error, in mean rest lengths, that single precision may cause in `steps` steps.
///
/// A position of magnitude |x| is rounded by at most 2^-24 |x| each time it is written, and the spring forces
/// carry the rounding of the positions on into the velocities. Measured over 100 steps of all cloths and
/// integrators, float backends end 13 to 63 such roundings away from the reference; allowed are two a step. A
/// backend that leaves out the springs' damping, or one pin, is off by 10 to 1000 times the tolerance
/// (tests/verification_test.cpp).
double position_tolerance(const System& system, int steps);

/// Runs the reference. It stops early, at a multiple of ten steps, rather than let a node touch the floor:
/// after a bounce, results differ by a step's worth of landing time, and a tolerance would mean nothing.
Reference run_reference(const System& system, const Integrator& integrator, double dt_s);

/// A backend's result against the reference.
struct Verification {
  double position_error = 0;  ///< largest distance between the same node's positions, in mean rest lengths
  double energy_drift =
      0;  ///< total energy less the reference's, over the reference's kinetic + elastic energy
  std::optional<std::string> failure;  ///< empty: verified
};

/// Steps the backend from the start and compares. Leaves the backend in any state.
Verification verify(Backend& backend, const System& system, const Reference& reference, double dt_s);

}  // namespace mssim
