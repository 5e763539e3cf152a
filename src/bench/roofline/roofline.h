#pragma once

#include <cstddef>
#include <cstdint>

#include "integrators/integrator.h"
#include "model/system.h"

namespace mssim {

/// The least work of one step, however a backend stores the state: the two axes of the roofline.
struct StepCost {
  double bytes = 0;  ///< moved between memory and registers
  double flops = 0;  ///< floating-point operations; a fused multiply-add counts as two
};

/// Floating-point operations per unique spring and stage, if the force is computed once and applied to both
/// ends. d and u are the differences of position and velocity between the ends:
///     d, u                           2 x 3 subtractions               6
///     d . d, u . d                   2 x (3 products, 2 sums)        10
///     spring_pull (spring_law.h)     root, reciprocal                 2 + spring_pull_flops
///     pull * d                       3 products                       3
///     onto one end, off the other    2 x 3 sums                       6
/// Root and reciprocal count as one operation each, as is usual, although they take longer; so the bound is
/// optimistic. Sign changes are free.
inline constexpr std::size_t flops_per_spring = 6 + 10 + (2 + spring_pull_flops) + 3 + 6;

/// Operations of the acceleration of one node (node_laws.h), if the springs' constants have been divided by
/// its mass: viscous damping (3 products, 3 sums) and gravity (1 sum).
inline constexpr std::size_t flops_per_acceleration = 3 + 3 + 1;

/// Operations of a stage's pointwise assignments for one node: in each of three components a product for
/// every term whose factor is not 1, and a sum between terms.
constexpr std::size_t line_flops(const Stage& stage) {
  std::size_t count = 0;
  for (const Assignment& assignment : stage.assignments) {
    for (std::size_t t = 0; t < term_count(assignment); ++t) {
      const bool multiplies = assignment.terms[t].coefficient != 1 || assignment.terms[t].dt_power != 0;
      count += std::size_t{multiplies} + std::size_t{t > 0};
    }
  }
  return 3 * count;
}

/// Vectors of three floats that a stage moves for one node: every slot that it reads and every slot that it
/// writes. The gathered pair counts once, however many neighbours read it. Values that live only within a
/// stage are free.
constexpr std::size_t slots_moved(const Stage& stage) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < memory_slots; ++i) {
    const auto slot = static_cast<Slot>(i);
    const bool gathered = slot == position_slot(stage.gather) || slot == velocity_slot(stage.gather);
    count += std::size_t{gathered || reads(stage, slot)} + std::size_t{writes(stage, slot)};
  }
  return count;
}

/// Size of the data that a step processes.
struct StepSize {
  std::uint64_t nodes = 0;
  std::uint64_t springs = 0;    ///< unique ones
  double bytes_per_spring = 0;  ///< connectivity and rest length of a spring in memory
};

/// The size of a system, with the least memory that a spring takes.
StepSize step_size(const System& system);

/// The size if memory holds only `stored` springs (Backend::stored_springs) and the others share theirs.
StepSize with_stored_springs(StepSize size, std::uint64_t stored);

/// Cost of a step that passes once per stage over the nodes and, if they take memory, the springs. If stages
/// overlap, so that one pass takes `steps_per_pass` whole steps (Backend::steps_per_pass), trial values never
/// leave a cache: a pass then moves the state, in and out, and the springs. Small contributions are left out:
/// pins, contact with the floor, and other data in the same cache lines.
StepCost step_cost(const Integrator& integrator, const StepSize& size, int steps_per_pass = 0);

/// Bytes of all slots and springs that a step of the integrator touches: the working set, whose cache level
/// bounds the step.
double working_set_bytes(const Integrator& integrator, const StepSize& size);

/// Peak rates of this machine with a number of threads: the roofs of the roofline.
struct MachinePeak {
  double bytes_per_second = 0;  ///< triad a = b + s c, 12 bytes per element (two loads, one store)
  double flops_per_second = 0;  ///< fused multiply-adds in single precision, two operations each
};

/// Measures both rates in this process with `threads` OpenMP threads (at least 1), in about a quarter of a
/// second. Takes the fastest of many repetitions, because a peak is the rate of the undisturbed machine. The
/// triad's three arrays together have about `working_set_bytes` (from 1.5 KiB per thread up to 256 MiB, which
/// no cache holds), so a step is compared with the cache level that it works in. Stores are tried both
/// through the caches and past them. Vector instructions are the widest that this processor has. Throws
/// std::bad_alloc.
MachinePeak measure_peak(int threads, std::size_t working_set_bytes);

/// The least time that the machine needs for the step, divided by the time it took: 1 on the roof. Source: S.
/// Williams, A. Waterman, D. Patterson, Roofline: An Insightful Visual Performance Model for Multicore
/// Architectures, Communications of the ACM 52 (2009), 65-76.
double roofline_fraction(const StepCost& cost, double seconds, const MachinePeak& peak);

}  // namespace mssim
