#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace mssim {

/// Explicit integrators are data: a list of stages, each of which evaluates the acceleration at one pair of
/// slots and then writes pointwise linear combinations. The host backends unroll the table at compile time,
/// and the OpenCL backends generate their program text from it, so the mathematics is written only here.
/// Implicit integrators have no stages: a Solver computes their new state.

/// A pair holds one position-like and one velocity-like vector for every node.
enum class Pair : std::uint8_t { state, next, trial_a, trial_b };
inline constexpr std::size_t pair_kinds = 4;

/// Vectors that an assignment may read or write. The first eight are in memory, pair by pair; the rest are in
/// registers within a stage.
enum class Slot : std::uint8_t { x, v, x_next, v_next, x_a, v_a, x_b, v_b, a, temporary_1, temporary_2 };
inline constexpr std::size_t memory_slots = 2 * pair_kinds;
inline constexpr std::size_t slot_kinds = memory_slots + 3;

/// coefficient * dt^dt_power * slot. A coefficient of zero ends the list of terms.
struct Term {
  double coefficient = 0;
  int dt_power = 0;
  Slot slot = Slot::a;
};
inline constexpr std::size_t max_terms = 5;

/// out = sum of the terms. Assignments are executed in order; later ones see earlier results. The first term
/// is the large one; it is added last, so a position is rounded once.
struct Assignment {
  Slot out = Slot::a;
  std::array<Term, max_terms> terms{};
};
inline constexpr std::size_t max_assignments = 4;

/// Evaluates the acceleration at `gather`, then executes the assignments.
struct Stage {
  Pair gather = Pair::state;
  std::array<Assignment, max_assignments> assignments{};
};
inline constexpr std::size_t max_stages = 4;

/// The method that computes the new state of an implicit step (src/backends/implicit/).
enum class Solver : std::uint8_t {
  none,          ///< the step is explicit: stages
  newton_step,   ///< one step of Newton's method from the state, by conjugate gradients
  newton,        ///< Newton's method until it converges
  local_global,  ///< alternating projections of single springs and solutions of one constant system
  constraints    ///< one spring after the other, in substeps
};

/// A step: the stages in order, or the solver. After it, `next` is the new state and the floor has acted on
/// it.
struct Integrator {
  std::string_view name;
  int order = 0;                   ///< order of convergence on smooth problems, measured by the tests
  std::size_t stage_count = 0;     ///< also the number of force evaluations; 0 for implicit ones
  std::string_view description{};  ///< one line for `mssim list integrators`
  /// The integrator of Hong et al. with whose published times its are compared: itself if the names are equal
  /// (is_of_paper), else one that evaluates the forces more often; empty for none.
  std::string_view paper_name{};
  std::array<Stage, max_stages> stages{};
  Solver solver = Solver::none;
  int damped_order = order;  ///< order of convergence if forces depend on velocities
  /// The row of the table that has these stages; null: this one is such a row.
  const Integrator* row = nullptr;
  /// How far the stages' positions are ahead of the state's, in steps (step_ahead,
  /// backends/interface/backend.h).
  double ahead = 0;
};

/// Whether Hong et al. measure this integrator itself.
constexpr bool is_of_paper(const Integrator& integrator) { return integrator.paper_name == integrator.name; }

/// Whether a solver computes its steps, not stages.
constexpr bool is_implicit(const Integrator& integrator) { return integrator.solver != Solver::none; }

/// Numbers, names and pairs of slots. position_slot and velocity_slot: the two slots of a pair.
constexpr std::size_t index(Slot slot) { return static_cast<std::size_t>(slot); }
constexpr std::size_t index(Pair pair) { return static_cast<std::size_t>(pair); }
inline constexpr std::array<std::string_view, slot_kinds> slot_names{
    "x", "v", "x_next", "v_next", "x_a", "v_a", "x_b", "v_b", "a", "temporary_1", "temporary_2"};
constexpr std::string_view name_of(Slot slot) { return slot_names[index(slot)]; }
constexpr Slot position_slot(Pair pair) { return static_cast<Slot>(2 * index(pair)); }
constexpr Slot velocity_slot(Pair pair) { return static_cast<Slot>(2 * index(pair) + 1); }

/// Number of terms before the one with coefficient zero.
constexpr std::size_t term_count(const Assignment& assignment) {
  std::size_t count = 0;
  while (count < max_terms && assignment.terms[count].coefficient != 0) ++count;
  return count;
}

/// Number of assignments before the one without terms.
constexpr std::size_t assignment_count(const Stage& stage) {
  std::size_t count = 0;
  while (count < max_assignments && term_count(stage.assignments[count]) > 0) ++count;
  return count;
}

/// The row of an explicit integrator.
constexpr Integrator of_stages(std::string_view name, int order, std::string_view description,
                               std::string_view paper_name, const std::array<Stage, max_stages>& stages) {
  std::size_t count = 0;
  while (count < max_stages && assignment_count(stages[count]) > 0) ++count;
  return {name, order, count, description, paper_name, stages};
}

/// Does the stage write the slot?
constexpr bool writes(const Stage& stage, Slot slot) {
  for (const Assignment& assignment : stage.assignments)
    if (term_count(assignment) > 0 && assignment.out == slot) return true;
  return false;
}

/// Does the stage write a slot of the pair?
constexpr bool writes(const Stage& stage, Pair pair) {
  return writes(stage, position_slot(pair)) || writes(stage, velocity_slot(pair));
}

/// Does the stage read the slot from memory, because an assignment uses it before one has written it? The
/// force reads the gathered pair in any case.
constexpr bool reads(const Stage& stage, Slot slot) {
  for (const Assignment& assignment : stage.assignments) {
    for (std::size_t t = 0; t < term_count(assignment); ++t)
      if (assignment.terms[t].slot == slot) return true;
    if (term_count(assignment) > 0 && assignment.out == slot) return false;
  }
  return false;
}

/// Does any stage read or write the pair in memory?
constexpr bool touches(const Integrator& integrator, Pair pair) {
  for (std::size_t s = 0; s < integrator.stage_count; ++s)
    for (const Slot slot : {position_slot(pair), velocity_slot(pair)})
      if (integrator.stages[s].gather == pair || reads(integrator.stages[s], slot) ||
          writes(integrator.stages[s], slot))
        return true;
  return false;
}

/// If neighbours are gathered while others are written, a stage must not write the pair that it gathers.
constexpr bool gathers_safely(const Integrator& integrator) {
  for (std::size_t s = 0; s < integrator.stage_count; ++s)
    if (writes(integrator.stages[s], integrator.stages[s].gather)) return false;
  return true;
}

/// The layout of the pairs in a backend's memory.
enum class Storage {
  separate,  ///< every pair has its own arrays, because another node could gather the new value
  in_place   ///< pairs share arrays if a pointwise update allows it
};

/// The array pair that stores `pair`. In place, the second trial pair shares the first one's arrays (a trial
/// is dead once the next one is written), and `next` shares the state's unless an earlier stage already
/// writes it.
constexpr Pair storage_of(const Integrator& integrator, Pair pair, Storage storage) {
  if (storage == Storage::separate) return pair;
  if (pair == Pair::trial_b) return Pair::trial_a;
  if (pair != Pair::next) return pair;
  for (std::size_t s = 0; s + 1 < integrator.stage_count; ++s)
    if (writes(integrator.stages[s], Slot::x_next) || writes(integrator.stages[s], Slot::v_next)) return pair;
  return Pair::state;
}

/// The arrays to which a stage writes `pair` if stages follow each other in a walk over the nodes. A step's
/// last stage writes `next` over the state, which no later stage of the step reads, wherever the step
/// gathered its `next`.
constexpr Pair walk_writes_to(const Integrator& integrator, std::size_t stage, Pair pair) {
  if (pair == Pair::next && stage + 1 == integrator.stage_count) return Pair::state;
  return storage_of(integrator, pair, Storage::in_place);
}

/// The pairs that this storage needs arrays for.
inline std::vector<Pair> stored_pairs(const Integrator& integrator, Storage storage) {
  std::vector<Pair> stored;
  for (std::size_t i = 0; i < pair_kinds; ++i) {
    const auto pair = static_cast<Pair>(i);
    if (touches(integrator, pair) && storage_of(integrator, pair, storage) == pair) stored.push_back(pair);
  }
  return stored;
}

/// Does the stage write values of `pair` that are gathered later, by another stage or as the state by the
/// next step?
constexpr bool writes_to_gather(const Integrator& integrator, std::size_t stage, Pair pair) {
  if (!writes(integrator.stages[stage], pair)) return false;
  if (pair == Pair::next && stage + 1 == integrator.stage_count) return true;
  for (std::size_t s = 0; s < integrator.stage_count; ++s)
    if (integrator.stages[s].gather == pair) return true;
  return false;
}

}  // namespace mssim
