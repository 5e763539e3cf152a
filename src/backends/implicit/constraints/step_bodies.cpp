// Small steps of bodies, colour by colour. Compiled once per instruction set: hwy/foreach_target.h includes
// this file again for each.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "backends/implicit/constraints/step_bodies.cpp"
#include "backends/implicit/constraints/step_bodies.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#include <omp.h>

#include <algorithm>
#include <bit>
#include <optional>

#include "backends/implicit/constraints/move_lanes-inl.h"
#include "backends/layouts/records-inl.h"
#include "backends/threads/spin_barrier.h"

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {

constexpr std::size_t vector_springs = hn::MaxLanes(FloatTag());

/// Writes the velocities of the nodes whose records lie at record(0), record(1) ..., one a lane, in stores of
/// blocks of four floats. Scatter instructions, one for each component, made a step of 38,233 and of 3,858
/// nodes take 1.8 to 2 times as long on Zen 4.
#if HWY_TARGET == HWY_SCALAR
template <class Record>
HWY_INLINE void scatter_velocities(const Lanes3& v, Record record) {
  const FloatTag d;
  hn::Store(v.x.v, d, record(0) + 4);
  hn::Store(v.y.v, d, record(0) + 5);
  hn::Store(v.z.v, d, record(0) + 6);
}
#else
template <class Tag, class V, class Record>
HWY_INLINE void store_blocks(Tag d, V blocks, std::size_t first, Record record) {
  if constexpr (hn::MaxLanes(Tag()) == 4) {
    hn::Store(blocks, d, record(first) + 4);
  } else {
    const hn::Half<Tag> half;
    store_blocks(half, hn::LowerHalf(half, blocks), first, record);
    store_blocks(half, hn::UpperHalf(half, blocks), first + hn::MaxLanes(Tag()) / 2, record);
  }
}
template <class Record>
HWY_INLINE void scatter_velocities(const Lanes3& v, Record record) {
  const FloatTag d;
  hn::Vec<FloatTag> blocks[4];  // block b of number i is that of lane 4 b + i
  transpose_blocks<hn::Vec<FloatTag> >(v.x.v, v.y.v, v.z.v, hn::Zero(d), blocks);
  for (std::size_t i = 0; i < 4; ++i) store_blocks(d, blocks[i], i, record);
}
#endif

/// The springs of vectors [begin, end) of a batch.
HWY_INLINE void project_batch(SpringBatches& bodies, const SpringBatches::Batch& batch, std::size_t begin,
                              std::size_t end) {
  const FloatTag d;
  float* const nodes = bodies.nodes.data();
  const Lanes h(bodies.h_s), stiffness(batch.stiffness), damping(batch.damping);
  const Lanes first_mobility(batch.first_mobility), second_mobility(batch.second_mobility);
  const float* const last = bodies.springs.data() + end * 3 * vector_springs;
  for (const float* entry = bodies.springs.data() + begin * 3 * vector_springs; entry < last;
       entry += 3 * vector_springs) {
    const auto first = [&](std::size_t i) MSSIM_INLINE_LAMBDA {
      return nodes + std::size_t{std::bit_cast<std::uint32_t>(entry[i])} * SpringBatches::offset_floats;
    };
    const auto second = [&](std::size_t i) MSSIM_INLINE_LAMBDA {
      return nodes + std::size_t{std::bit_cast<std::uint32_t>(entry[vector_springs + i])} *
                         SpringBatches::offset_floats;
    };
    const NodeLanes a = load_records<vector_springs>(first), b = load_records<vector_springs>(second);
    const Lanes3 u = b.v - a.v, way = mul_add(h, u, b.x - a.x);
    const Lanes pull = spring_pull_at(inverse_length(dot(way, way)), dot(u, way), stiffness,
                                      Lanes(hn::Load(d, entry + 2 * vector_springs)), damping);
    scatter_velocities(mul_add(first_mobility * pull, way, a.v), first);
    scatter_velocities(mul_add(-(second_mobility * pull), way, b.v), second);
  }
}

/// A thread's share, by vectors, of a colour.
HWY_NOINLINE inline void project_colour(SpringBatches& bodies, const SpringBatches::Colour& colour,
                                        std::size_t thread, std::size_t threads) {
  const std::size_t first = bodies.batches[colour.begin].begin, vectors = bodies.vectors(colour);
  const std::size_t begin = first + vectors * thread / threads,
                    end = first + vectors * (thread + 1) / threads;
  for (std::size_t i = colour.begin; i < colour.end; ++i) {
    const SpringBatches::Batch& batch = bodies.batches[i];
    project_batch(bodies, batch, std::max(begin, batch.begin), std::min(end, batch.end));
  }
}

/// What happens to the nodes between the springs of one small step and those of the next.
struct Between {
  bool advances;     ///< x += h v: not before the first one
  bool meets_floor;  ///< behind that: the small step was the last of a step
  bool falls;        ///< v = (v - h g) / (1 + h c): not after the last one
};

/// That, at vectors [begin, end) of nodes.
HWY_NOINLINE inline void move_nodes(SpringBatches& bodies, const Between& between, std::size_t begin,
                                    std::size_t end) {
  const FloatTag d;
  const Lanes h(bodies.h_s), gravity(bodies.fall), kept(bodies.kept);
  for (std::size_t vector = begin; vector < end; ++vector) {
    float* const records = bodies.nodes.data() + vector * vector_springs * record_floats;
    NodeLanes node = load_records<vector_springs>(
        [&](std::size_t i) MSSIM_INLINE_LAMBDA { return records + i * record_floats; });
    const Mask moves = hn::Ne(hn::Load(d, bodies.free.data() + vector * vector_springs), hn::Zero(d));
    if (between.advances) {
      float* const rest = bodies.rest.data() + vector * 3 * vector_springs;
      Lanes3 lacks = load3(rest);
      carry_sum(node.x, lacks, h, node.v);  // pins have no velocity
      if (between.meets_floor) meet_floor(moves, bodies.surroundings, node, lacks);
      store3(rest, lacks);
    }
    if (between.falls) node.v = fallen(moves, node.v, gravity, kept);
    store_records<vector_springs>(records, node);
  }
}

/// How a thread meets those that share a part with it: not at all.
struct Alone {
  HWY_INLINE void meet() const {}
  template <class TakeRound>
  HWY_INLINE std::size_t end_round(TakeRound&& /*take_round*/) const {
    return 0;
  }
};

/// At a barrier. One of them may take small steps for all.
struct Together {
  SpinBarrier& barrier;
  HWY_INLINE void meet() const { barrier.wait(); }
  template <class TakeRound>
  HWY_INLINE std::size_t end_round(TakeRound&& take_round) const {
    return barrier.end_round(take_round);
  }
};

/// A thread's share of a small step of a part, up to the last colour; what moves its nodes stands before it.
template <class Team>
HWY_INLINE void step_colours(SpringBatches& bodies, const SpringBatches::Part& part, std::size_t small,
                             std::size_t thread, std::size_t threads, const Team& team) {
  const std::size_t vectors = part.end - part.begin;
  move_nodes(bodies, {small > 0, small > 0 && small % bodies.substeps == 0, true},
             part.begin + vectors * thread / threads, part.begin + vectors * (thread + 1) / threads);
  for (std::size_t colour = part.first_colour; colour < part.end_colour; ++colour) {
    team.meet();
    project_colour(bodies, bodies.colours[colour], thread, threads);
  }
}

/// A thread's share of `count` small steps of a part.
template <class Team>
HWY_INLINE void step_part(SpringBatches& bodies, const SpringBatches::Part& part, std::size_t count,
                          std::size_t thread, std::size_t threads, const Team& team) {
  if (count == 0) return;
  for (std::size_t small = 0; small < count; ++small) {
    step_colours(bodies, part, small, thread, threads, team);
    small += team.end_round([&](std::size_t taken) HWY_ATTR {
      const std::size_t next = small + 1 + taken;
      if (next >= count) return false;
      step_colours(bodies, part, next, 0, 1, Alone());
      return true;
    });
  }
  const std::size_t vectors = part.end - part.begin;
  move_nodes(bodies, {true, true, false}, part.begin + vectors * thread / threads,
             part.begin + vectors * (thread + 1) / threads);
}

/// Takes `count` steps.
void step_bodies(SpringBatches& bodies, int count) {
  // The springs of a colour share no node, and parts share nothing: the result is the same to the last bit
  // for any number of threads.
  const std::size_t small_steps = static_cast<std::size_t>(count) * bodies.substeps;
  std::optional<SpinBarrier> barrier;
#pragma omp parallel num_threads(static_cast <int>(bodies.threads))
  {
    const auto thread = static_cast<std::size_t>(omp_get_thread_num());
    const auto threads = static_cast<std::size_t>(omp_get_num_threads());  // the runtime may give fewer
#pragma omp single
    barrier.emplace(threads, bodies.team_gain);
    for (const std::size_t part : bodies.shared_parts)
      step_part(bodies, bodies.parts[part], small_steps, thread, threads, Together{*barrier});
    for (std::size_t owner = thread; owner < bodies.own_parts.size(); owner += threads)
      for (const std::size_t part : bodies.own_parts[owner])
        step_part(bodies, bodies.parts[part], small_steps, 0, 1, Alone());
  }
}

BodyConstraintKernel body_constraint_kernel() {
  return {vector_springs, hwy::TargetName(HWY_TARGET), exact_roots, &step_bodies};
}

}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mssim {
HWY_EXPORT(body_constraint_kernel);
std::vector<BodyConstraintKernel> body_constraint_kernels() {
  return kernels_of_this_processor(HWY_DISPATCH_TABLE(body_constraint_kernel));
}
}  // namespace mssim
#endif
