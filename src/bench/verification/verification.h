#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "backends/interface/backend.h"
#include "model/energy.h"

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

/// Finds the first bad step by any way to find the first bad node so many steps after the start.
std::optional<BlowUp> find_blow_up(const std::function<std::optional<std::size_t>(int steps)>& bad_node_after,
                                   int steps);

/// "blew up at step 12 (t = 0.0012 s): node 34 is not finite; ..." with the remedy. `steps_before` were taken
/// before.
std::string describe(const BlowUp& blow_up, double dt_s, std::int64_t steps_before = 0);

/// How far a state is from another one of the same system.
struct Deviation {
  double position = 0;  ///< largest distance between the same node's positions, in mean rest lengths
  double energy = 0;    ///< total energy less the other's, over the other's energy in motion
};

/// What differences from the energy of a state are a share of, J: its kinetic and elastic energy, and of one
/// at rest a hundred times the elastic energy of what single precision rounds. Of a spring that is
/// k / 2 (8 u)^2 |x|^2 / 3, x the place of its end and u = 2^-24: backends in single precision end 8 to 12
/// roundings of a coordinate away from the reference after 100 steps (position_tolerance).
double energy_in_motion(const System& system, const State& state, const Energy& energy);

/// `state` against `reference`, whose energy is `energy`.
Deviation deviation_from(const System& system, const State& reference, const Energy& energy,
                         const State& state);

/// The largest distance between the same node's positions, in mean rest lengths.
double position_deviation(const System& system, const State& reference, const State& state);

/// What the double-precision reference reached: the yardstick for every backend of a scene and integrator.
struct Reference {
  int steps = 0;  ///< taken from the start; before any node touches the floor, and comparable
  State state;
  Energy energy;
  double tolerance = 0;     ///< on the position error, in mean rest lengths
  double step_seconds = 0;  ///< that a step of it took: the median, because the first ones are slow
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
