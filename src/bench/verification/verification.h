#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "backends/interface/backend.h"
#include "model/system.h"

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

/// Whether no node is on the floor, or below it.
bool is_in_the_air(const State& state, const Floor& floor);

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
  bool recalled = false;    ///< an earlier run of the program has found it (reference_cache.h)
  std::optional<std::string> failure;  ///< why there is no reference
};

/// Steps of a verification run: enough for a wrong force to show, few enough that rounding does not.
inline constexpr int verification_steps = 100;

/// Steps that a reference, and what is stepped beside it, takes between two looks at the floor and at whether
/// to end.
inline constexpr int steps_between_looks = 10;

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
/// tolerance would mean nothing. Throws Interrupted where an ending signal is noted (platform/process.h), for
/// a large system takes minutes.
Reference run_reference(const System& system, const Integrator& integrator, double dt_s);

/// A backend's result against the reference.
struct Verification {
  double position_error = 0;  ///< largest distance between the same node's positions, in mean rest lengths
  double energy_drift =
      0;  ///< total energy less the reference's, over the reference's kinetic + elastic energy
  std::optional<std::uint64_t> state_hash;  ///< of the state after the last step (model/system.h)
  std::optional<std::string> failure;       ///< empty: verified
};

/// Steps the backend from the start and compares, where that is not what it has done already: `steps_taken`
/// says how many steps from the start it is. Leaves the backend in any state.
Verification verify(Backend& backend, const System& system, const Reference& reference, double dt_s,
                    int steps_taken = 0);

/// Takes steps and rounds the state to single precision after each: where roundings alone lead. Returns the
/// last state.
State step_rounded(Backend& reference, int steps);

/// Tetrahedra that need no mesher.
struct SolidBlock {
  std::vector<Vec3d> position;  ///< [nodes] m
  std::vector<Tetrahedron> tetrahedra;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;  ///< of the tetrahedra, each once, ascending
};

/// Adds a block of nx x ny x nz nodes, `spacing` m apart, x fastest, from `corner` on: each cube of
/// neighbours cut into six tetrahedra around its diagonal (Kuhn's cut).
void add_block(SolidBlock& blocks, std::uint32_t nx, std::uint32_t ny, std::uint32_t nz, double spacing,
               const Vec3d& corner);

/// The second part of a verification: a small scene of the same kind, materials, laws and step, near the
/// origin, where positions are rounded least. It moves more than a scene does at its start, and meets a
/// floor, on which it slides. What a large scene hides shows here: one spring of many, a few thousandths of a
/// stiffness, the air, the floor.
struct SecondStretch {
  System system;  ///< a cloth of 13 x 17 nodes, or two blocks of 4 x 5 x 6 nodes
  int steps = 0;
  State state;             ///< of the double-precision reference after them
  double tolerance = 0;    ///< on the position error, in mean rest lengths
  std::size_t landed = 0;  ///< nodes that have met the floor by then, and slid on it
};

/// Runs the reference of the second stretch of a scene that is a cloth or bodies: up to 400 steps. It ends
/// before the first step in which a rounding may decide whether a node meets the floor, and where roundings
/// stay within the tolerance (position_tolerance), as a reference beside it shows that is rounded to single
/// precision after every step. Of eight starts it takes the first that goes half of the way with ten nodes
/// that land, or the one that goes furthest.
SecondStretch run_second_stretch(const System& scene, const Integrator& integrator, double dt_s);

/// Why a backend made for the stretch's system and at its start is wrong; nothing where it is right.
std::optional<std::string> verify_second(Backend& backend, const SecondStretch& stretch);

/// Where the samples of a round start: at the system's start, with a wave on the velocities that is another
/// one for every number. Nobody knows where it leads who has not stepped it. The wave strains springs by
/// about a thousandth, and moves nodes further than the tolerance of a comparison. In single precision.
State sample_start(const System& system, std::uint32_t number);

/// What is kept of the state that a sample has ended with.
struct SampleEnd {
  int steps = 0;
  std::vector<Vec3d> positions;  ///< of the nodes that are looked at, m
  double energy_j = 0;           ///< of all nodes
};

/// A sample's end. Of a large scene every so manieth node is looked at, from the one after `first` on, so
/// that they are a million at most.
SampleEnd sample_end(const System& system, const State& state, int steps, std::size_t first);

/// Compares ends of samples that all began with `start` with the double-precision reference of as many steps:
/// for each of them why it is wrong, or nothing. `first` as for sample_end.
///
/// Allowed is the tolerance of a verification of as many steps (position_tolerance). But motions of the scene
/// itself (folds of a cloth under pressure) may make more of a rounding than a random walk does, which a
/// second reference shows, whose state is rounded to single precision after every step. Backends in single
/// precision end 0.5 to 1.7 times as far from the first one as it does with semi-euler, and 2 to 4 times with
/// rk4, whose steps round four times (cloths and bodies of the paper, 100 to 2,000 steps). Where that is
/// more, four times that a rounding is allowed, in scenes of up to a million nodes; and after a node has met
/// the floor the way of the fastest node in four steps besides, because a rounding may let a node land a step
/// later.
std::vector<std::string> check_samples(const System& system, const Integrator& integrator, double dt_s,
                                       const State& start, std::size_t first,
                                       std::span<const SampleEnd> ends);

/// Accounts for what damping, friction and bounces take, so that kinetic + elastic + gravitational energy +
/// losses stays constant.
///
/// The losses of a step follow from the laws and from the state that the backend starts it with, never from
/// the backend's result. A double-precision reference of the same integrator takes the same step with the
/// floor out of reach; then the floor's law is applied to the nodes that have fallen below it. So
///   damping      the trapezoidal rule over damping_power before and after the reference's step,
///   friction     the kinetic energy of sliding that the floor's law takes,
///   bounce       in a step in which a node meets the floor, what else the step loses: the kinetic energy of
///                falling that the law takes, less what lifting nodes onto the floor gives them,
///   integration  in all other steps, what else they lose: the integrator's error.
/// (An integrator's error cannot be told from the floor's taking while a node is on it: falling through the
/// floor for a step and being put back is how a floor holds a node, and for semi-implicit Euler both are of
/// the same order and of unlike signs.)
/// A backend with another force or floor, or with another integrator, makes the balance fail. One in single
/// precision that is right keeps it, in shares of the largest change of the kinetic energy and over ten to
/// twenty thousand steps, to 1e-4 for bodies on a floor at height 0 and for cloths, and to some 1e-3 on a
/// floor so high that the steps of nodes at rest on it are of the size of a rounding.
///
/// `integration` has the error of the trapezoidal rule in it, too. Of the kinetic energy of their fall, in a
/// second with bounces, the small bodies of the paper lose or gain 0.001 by it with semi-implicit Euler and
/// gain 0.002 to 0.05 with midpoint and rk4, and 0.08 to 0.5 with the frozen methods, which take damping and
/// stiffness from the start of the step.
class EnergyLedger {
 public:
  /// `system` and `integrator` must outlive the ledger; `dt_s` is the step of the backends that it follows.
  EnergyLedger(const System& system, const Integrator& integrator, double dt_s);

  /// Lets the backend, one of the ledger's system, integrator and dt, take a step, and accounts for it.
  void step(Backend& backend);
  /// Since the ledger was made.
  const EnergyLosses& losses() const { return losses_; }

 private:
  /// Returns whether any node meets the floor.
  bool account_for_contact(const State& landing);

  const System& system_;
  System floorless_;  // the same with the floor out of reach
  double dt_s_;
  std::unique_ptr<Backend> reference_;  // of floorless_
  std::vector<std::uint8_t> pinned_;    // [nodes]
  std::vector<std::uint8_t> touches_;   // [nodes] does the step under way end on the floor?
  EnergyLosses losses_;
};

}  // namespace mssim
