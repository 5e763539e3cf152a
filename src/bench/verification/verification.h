#pragma once

#include <cstddef>
#include <cstdint>
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

/// Where a simulation blew up: the first step whose result is not finite in single precision, and the first
/// such node. Most backends compute and traces are stored in single precision. Energies of numbers that are
/// finite in it are finite in double precision.
struct BlowUp {
  int step = 0;  ///< counted from 1
  std::size_t node = 0;
};

/// Reported if steps blow up, but do not when repeated.
inline constexpr std::string_view finite_in_the_next =
    "not finite in one run, finite in the next: a data race";

/// The first node whose position or velocity is not finite in single precision.
std::optional<std::size_t> first_bad_node(const State& state);

/// Whether every node is above the floor.
bool is_in_the_air(const State& state, const Floor& floor);

/// Finds the first bad step of a simulation that was bad `steps` steps after `from`, by bisection: a number
/// that is not finite stays so. Leaves the backend in any state. Empty if the repeated simulation is good.
std::optional<BlowUp> find_blow_up(Backend& backend, const State& from, int steps);

/// Remedy for a simulation that blows up with the scene's time step.
inline constexpr std::string_view shorter_scene_step = "take a smaller dt_s or \"auto\"";

/// "blew up at step 12 (t = 0.0012 s): node 34 is not finite; ..." with the remedy. `steps_before` is added
/// to the step number.
std::string describe(const BlowUp& blow_up, double dt_s, std::int64_t steps_before = 0,
                     std::string_view remedy = shorter_scene_step);
/// Follows the remedy of describe() for a backend, which may be the only one that blows up.
inline constexpr std::string_view unless_alone = " if other backends blow up, too";

/// Distance of a state from another state of the same system.
struct Deviation {
  double position = 0;  ///< largest distance between the same node's positions, in mean rest lengths
  double energy = 0;    ///< total energy less the other's, divided by the other's energy in motion
};

/// The energy that differences of energy are divided by, J: the state's kinetic and elastic energy. For a
/// state at rest, it is a hundred times the elastic energy of rounding to single precision. For a spring that
/// is k / 2 (8 u)^2 |x|^2 / 3, with the position x of its end and u = 2^-24: backends in single precision end
/// 8 to 12 roundings of a coordinate away from the reference after 100 steps (position_tolerance).
double energy_in_motion(const System& system, const State& state, const Energy& energy);

/// Deviation of `state` from `reference`, whose energy is `energy`.
Deviation deviation_from(const System& system, const State& reference, const Energy& energy,
                         const State& state);

/// The largest distance between the same node's positions, in mean rest lengths.
double position_deviation(const System& system, const State& reference, const State& state);

/// Result of the double-precision reference, with which every backend of a scene and integrator is compared.
struct Reference {
  const Integrator* integrator = nullptr;  ///< whose steps they are
  int steps = 0;  ///< since the start; before any node touches the floor, and comparable (comparable_steps)
  State state;
  Energy energy;
  double tolerance = 0;                ///< on the position error, in mean rest lengths
  double step_seconds = 0;             ///< median time per step; the first steps are slow
  bool recalled = false;               ///< found by an earlier run of the program (reference_cache.h)
  std::optional<std::string> failure;  ///< why there is no reference
};

/// Steps of a verification run: enough for a wrong force to show, few enough that rounding does not.
inline constexpr int verification_steps = 100;

/// Steps that a reference takes between two checks of signals, and of the floor while that is far; so does a
/// backend that steps meanwhile.
inline constexpr int steps_between_looks = 10;

/// Largest allowed difference of total energy, as a fraction of the energy in motion (energy_in_motion).
inline constexpr double energy_tolerance = 0.01;

/// Number of stages of a step that write, and so round, the new position.
int position_roundings(const Integrator& integrator);

/// Steps from the start until a rounding error may have doubled, at least 1 and at most `most`; beyond them a
/// tolerance for roundings is meaningless. Derived from the factors by which the integrator multiplies the
/// system's modes (stability.h), which lie between those of its spectrum. `most` if it is stable.
int comparable_steps(const System& system, const Integrator& integrator, double dt_s, int most);

/// Largest position error, in mean rest lengths, that single precision may cause in `steps` steps.
///
/// A stage that writes the new position rounds it by at most u = 2^-24 of its magnitude. Independent
/// roundings add up like a random walk, with the square root of their number. Float backends behave like
/// that: after 100 steps of all cloths, methods with one such stage end 8 to 12 u |x| away from the
/// reference, RK4 with four of them 24 to 53. The tolerance is four times the square root. An implicit step
/// writes the position once. The small steps of xpbd write it and the velocity more often, but carry the
/// error of each sum. tests/bench/verification/verification_test.cpp proves that a missing spring or pin, or
/// one kind of spring 1 % too stiff, exceeds the tolerance.
double position_tolerance(const System& system, const Integrator& integrator, int steps);

/// Largest such tolerance, in mean rest lengths, and largest fraction of the energy in motion that is allowed
/// for roundings. With larger ones a comparison would not show much.
inline constexpr double largest_tolerance = 0.1;

/// Reason for a missing reference if a node touches the floor within the first steps.
std::string touches_at_once(int steps);

/// Runs the reference. Its state is that after verification_steps, or at the last of comparable_steps, or at
/// the last look before any node touches the floor: after a bounce, results differ by the motion within one
/// step, and a tolerance would be meaningless. Throws Interrupted if an ending signal is noted
/// (platform/process.h), because a large system takes minutes.
Reference run_reference(const System& system, const Integrator& integrator, double dt_s);

/// Comparison of a backend with the reference.
struct Verification {
  /// Largest distance between the same node's positions, in mean rest lengths; none if nothing was compared.
  std::optional<double> position_error = {};
  /// Total energy less the reference's, divided by the reference's energy in motion; none as above.
  std::optional<double> energy_drift = {};
  std::optional<std::uint64_t> state_hash = {};  ///< of the state after the last step (model/system.h)
  std::optional<std::string> failure = {};       ///< empty: verified
};

/// Compares the backend with the reference. If it is further away than independent roundings explain, a
/// second reference, rounded to single precision after every step, shows what they do to this scene, in
/// scenes of up to a million nodes: where steps move nodes by few units in their last place, roundings have
/// one sign for many steps. Then four times its deviation per rounding of a step is allowed, but no more than
/// largest_tolerance. First steps the backend from the start, unless it already is
/// reference.steps steps from there: `steps_taken` is its number. Leaves the backend in any state.
Verification verify(Backend& backend, const System& system, const Reference& reference, double dt_s,
                    int steps_taken = 0);

/// A state, and the time by which the steps before it were postponed until it was requested.
struct TimedState {
  State state;
  /// s: how much longer it took to read than a state after one step; 0 if it was read faster than its steps
  /// were taken.
  double postponed_s = 0;
};

/// Reads the backend's state after steps from `start` that took `steps_s`. Leaves the backend in any state.
TimedState read_state(Backend& backend, const State& start, double steps_s);

/// "it reports steps before they are done: ...", for a backend that took `steps_s` for its steps and
/// postponed them by at least `postponed_s`.
std::string describe_postponed(int steps, double steps_s, double postponed_s);

/// Takes steps and rounds velocities and positions to single precision after each, to show the effect of
/// roundings. Returns the last state. The positions are those that the stages see, `ahead_s` ahead of the
/// state's (step_ahead), as in a backend in single precision: while nodes fall alike, roundings have one sign
/// for many steps, and those of other positions differ.
State step_rounded(Backend& reference, double ahead_s, int steps);

/// Nodes and tetrahedra that are made without a mesher.
struct SolidBlock {
  std::vector<Vec3d> position;  ///< [nodes] m
  std::vector<Tetrahedron> tetrahedra;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;  ///< of the tetrahedra, each once, ascending
};

/// Adds a block of nx x ny x nz nodes, `spacing` m apart, x fastest, from `corner` on. Each cube of
/// neighbours is cut into six tetrahedra around its diagonal (Kuhn's cut).
void add_block(SolidBlock& blocks, std::uint32_t nx, std::uint32_t ny, std::uint32_t nz, double spacing,
               const Vec3d& corner);

/// The second part of a verification: a small scene with the kind, materials, laws and step of the first. It
/// is near the origin, where positions are rounded least, moves more than a scene does at its start, and
/// slides on a floor. It shows errors that a large scene hides: one spring among many, a stiffness wrong by a
/// few thousandths, the air, the floor.
struct SecondStretch {
  System system;  ///< a cloth of 13 x 17 nodes, or two blocks of 4 x 5 x 6 nodes
  int steps = 0;
  State state;           ///< of the double-precision reference after `steps`
  double tolerance = 0;  ///< on the position error, in mean rest lengths
  /// On the velocity error, m/s: that of the stiffest mode of a stable step, if its position error is the
  /// tolerance.
  double velocity_tolerance = 0;
  std::size_t landed = 0;  ///< nodes that have met the floor by then and slid on it
  int most_steps = 0;      ///< the largest number of steps that was tried
};

/// Runs the reference of the second stretch of a cloth or of bodies, for up to 400 steps. It ends before the
/// first step in which a rounding may decide whether a node meets the floor. At its last step, the effect of
/// roundings is within the tolerance (position_tolerance); a second reference, rounded to single precision
/// after every step, shows that effect. Of eight starts it takes the first that reaches half of the steps
/// with ten landed nodes, or else the one that reaches most steps.
SecondStretch run_second_stretch(const System& scene, const Integrator& integrator, double dt_s);

/// Why the backend is wrong; none if it is right. It must be made for the stretch's system and be at its
/// start.
std::optional<std::string> verify_second(Backend& backend, const SecondStretch& stretch);

/// Start state of the samples of a round, in single precision: the system's start with a wave on the
/// velocities that depends on `number`. Its result cannot be known without stepping it. The wave strains
/// springs by about a thousandth, and moves nodes further than the tolerance of a comparison.
State sample_start(const System& system, std::uint32_t number);

/// The part of a sample's last state that is kept.
struct SampleEnd {
  int steps = 0;
  std::vector<Vec3d> positions;  ///< of the examined nodes, m
  double energy_j = 0;           ///< of all nodes
};

/// Takes the end of a sample. Of a large scene only every n-th node from `first` on is examined, at most a
/// million.
SampleEnd sample_end(const System& system, const State& state, int steps, std::size_t first);

/// Compares the ends of samples that all started from `start` with the double-precision reference after as
/// many steps. Returns for each why it is wrong; empty if it is right. `first` as for sample_end.
///
/// The allowed deviation is the tolerance of a verification of as many steps (position_tolerance). But
/// motions of the scene itself (folds of a cloth under pressure) may amplify a rounding more than a random
/// walk does. A second reference, whose state is rounded to single precision after every step, shows this.
/// Backends in single precision end 0.5 to 1.7 times as far from the first reference as it does with
/// semi-euler, and 2 to 4 times with rk4, whose steps round four times (cloths and bodies of the paper, 100
/// to 2,000 steps). If that is more, four times the second reference's deviation per rounding is allowed, in
/// scenes of up to a million nodes. It takes one and a half times as long as the first, and only runs if an
/// end exceeds the tolerance otherwise. It may come near by chance: an end that exceeds this, too, is
/// compared with up to two more, from starts that are displaced by less than a rounding. After a node has met
/// the floor, the way of the fastest node in four steps is added, or that of the node whose landings are
/// fastest in sum, because a rounding may delay each landing by a step; to the energy, what gravity does
/// meanwhile to all nodes that land.
std::vector<std::string> check_samples(const System& system, const Integrator& integrator, double dt_s,
                                       const State& start, std::size_t first,
                                       std::span<const SampleEnd> ends);

/// Accounts for the energy lost to damping, friction and bounces, so that kinetic + elastic + gravitational
/// energy + losses stays constant.
///
/// The losses of a step follow from the laws and from the state in which the backend starts the step, never
/// from the backend's result. A double-precision reference of the same integrator takes the same step with
/// the floor out of reach; then the floor's law is applied to the nodes that have fallen below it. The losses
/// are:
///   damping      the trapezoidal rule over damping_power before and after the reference's step,
///   friction     the kinetic energy of sliding that the floor's law removes,
///   bounce       in a step in which a node meets the floor, the rest of the step's loss: the kinetic energy
///                of falling that the law removes, less the energy of lifting nodes onto the floor,
///   integration  in all other steps, the rest of the loss: the integrator's error.
/// The integrator's error cannot be separated from the floor's loss while a node touches the floor. The floor
/// holds a node by putting it back after it has fallen through for a step; with semi-implicit Euler, both are
/// of the same order and opposite signs. The floor meets the positions that the stages see, which are ahead
/// of the state's with some integrators (step_ahead); what move_back() puts on the floor counts as bounce. A
/// backend with a wrong force, floor or integrator violates the balance. A correct backend in single
/// precision keeps it over ten to twenty thousand steps, relative to the largest change of the kinetic
/// energy: to 1e-4 with semi-implicit Euler, for cloths and for bodies, and to about 1e-3 with rk4, on a
/// floor at height 0. It cannot keep it on a floor so high that the steps of nodes at rest on it are of the
/// size of a rounding: there the balance only shows roundings.
///
/// `integration` includes the error of the trapezoidal rule. In a second with bounces, relative to the
/// kinetic energy of the fall, the small bodies of the paper lose or gain 0.001 by it with semi-implicit
/// Euler, gain 0.002 to 0.05 with midpoint and rk4, and 0.08 to 0.5 with the frozen methods, which take
/// damping and stiffness from the start of the step.
class EnergyLedger {
 public:
  /// `system` and `integrator` must outlive the ledger; `dt_s` is the step of the backends that it follows.
  EnergyLedger(const System& system, const Integrator& integrator, double dt_s);

  /// Steps the backend once and accounts for its losses. The backend must have the ledger's system,
  /// integrator and dt.
  void step(Backend& backend);
  /// Losses since the ledger was made, J.
  const EnergyLosses& losses() const { return losses_; }

 private:
  /// Returns whether any node meets the floor.
  bool account_for_contact(const State& landing);

  const System& system_;
  System floorless_;  // `system_` with the floor out of reach
  double dt_s_;
  double ahead_s_;                      // of the positions that the stages see (Integrator::ahead)
  std::unique_ptr<Backend> reference_;  // of floorless_
  std::vector<std::uint8_t> pinned_;    // [nodes]
  std::vector<std::uint8_t> touches_;   // [nodes] whether the current step ends on the floor
  EnergyLosses losses_;
};

}  // namespace mssim
