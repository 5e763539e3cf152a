// The walk over bodies in slices: chunk by chunk, whichever thread is free. Compiled once per instruction
// set, so the guard toggles.
#if defined(MSSIM_SLICE_STEPS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MSSIM_SLICE_STEPS_INL_H_
#undef MSSIM_SLICE_STEPS_INL_H_
#else
#define MSSIM_SLICE_STEPS_INL_H_
#endif

#include <bit>
#include <utility>

#include "backends/layouts/slice_entries.h"
#include "backends/layouts/update_nodes-inl.h"
#include "backends/openmp/body_spring-inl.h"
#include "backends/openmp/chunk_phases-inl.h"
#include "backends/openmp/sliced_bodies.h"

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {

/// Some microseconds (work_in_phases).
constexpr int slice_spins = 300;

/// Entries one after the other, whatever their slices. The records that the next one names are loaded and
/// transposed before the springs of this one are computed: that takes long, and a processor does not look far
/// enough ahead. Measured on an Intel Xeon, one thread, bodies3858 and bodies38233: 0.97 and 0.90 of the
/// time; with AVX2 or SSE4, bodies3858: 0.95 and 0.93.
class EntryWalk {
 public:
  /// `pair`: what is gathered.
  HWY_INLINE EntryWalk(const SlicedBodies& bodies, const float* pair, std::size_t first_slice)
      : pair_(pair), entry_(first_entry(bodies, first_slice)), next_(load()) {}

  /// Where the entries of a slice begin.
  static HWY_INLINE const float* first_entry(const SlicedBodies& bodies, std::size_t slice) {
    return bodies.entries.data() + bodies.first_entry[slice] * floats;
  }
  HWY_INLINE bool is_before(const float* end) const { return entry_ < end; }
  /// SlicedGraph::stiffness_rest of this entry.
  HWY_INLINE Lanes stiffness_rest() const { return hn::Load(FloatTag(), entry_ + vector_nodes); }
  /// The neighbours that this entry names; goes on to the next one.
  HWY_INLINE NodeLanes take() {
    const NodeLanes taken = next_;
    entry_ += floats;
    next_ = load();  // slice_entries() has one more behind the last one
    return taken;
  }

 private:
  static constexpr std::size_t floats = 2 * vector_nodes;

  HWY_INLINE NodeLanes load() const {
    return load_records<vector_nodes>([&](std::size_t i) MSSIM_INLINE_LAMBDA {
      return pair_ + std::size_t{std::bit_cast<std::uint32_t>(entry_[i])} * slice_offset_floats;
    });
  }

  const float* const pair_;
  const float* entry_;
  NodeLanes next_;
};

/// Acceleration that the springs of a slice's nodes give them, neighbour by neighbour in the order of
/// entries, which end at `end`.
HWY_INLINE Lanes3 spring_acceleration(EntryWalk& entries, const float* end, const NodeLanes& node,
                                      Lanes stiffness, Lanes damping) {
  Lanes3 sum = zero3();
  while (entries.is_before(end)) {
    const Lanes stiffness_rest = entries.stiffness_rest();
    const NodeLanes other = entries.take();
    const Lanes3 to_other = other.x - node.x;
    // An empty entry's pull is finite and its length zero: it gives no force.
    const Lanes pull = body_spring_pull(to_other, other.v - node.v, {stiffness, stiffness_rest, damping});
    sum = mul_add(pull, to_other, sum);
  }
  return sum;
}

/// One stage at the nodes of one slice.
template <std::size_t method, std::size_t stage>
HWY_INLINE void step_slice(const SlicedBodies& bodies, const Pairs& base, std::size_t slice,
                           EntryWalk& entries) {
  const std::size_t offset = slice * vector_nodes * record_floats;
  const NodeLanes node = load_nodes(base[index(integrators[method].stages[stage].gather)] + offset);
  const float* constants = bodies.constants.data() + slice * 3 * vector_nodes;
  const Mask free = hn::Eq(hn::Load(FloatTag(), constants + 2 * vector_nodes), hn::Zero(FloatTag()));
  const Lanes3 a = spring_acceleration(entries, EntryWalk::first_entry(bodies, slice + 1), node,
                                       Lanes(hn::Load(FloatTag(), constants)),
                                       Lanes(hn::Load(FloatTag(), constants + vector_nodes)));
  update_nodes<method, stage>(base, offset, node, a, free, bodies.coefficients, bodies.surroundings);
}

template <std::size_t method, std::size_t stage>
HWY_NOINLINE void step_chunk(const SlicedBodies& bodies, const Pairs& base, SlicedBodies::Chunk chunk) {
  EntryWalk entries(bodies, base[index(integrators[method].stages[stage].gather)], chunk.begin);
  for (std::size_t slice = chunk.begin; slice < chunk.end; ++slice)
    step_slice<method, stage>(bodies, base, slice, entries);
}

/// Works on a chunk in a stage, counted from the first one of the call.
template <std::size_t method>
HWY_INLINE void work_on(const SlicedBodies& bodies, std::uint32_t number, SlicedBodies::Chunk chunk) {
  const Pairs base = pairs_in<method>(bodies.base, number);
  for_each_stage<method>([&](auto stage) HWY_ATTR {
    if (number % integrators[method].stage_count == stage) step_chunk<method, stage>(bodies, base, chunk);
  });
}

/// Stages of a part. Each is two phases: nodes without ghosts for neighbours are stepped while messages bring
/// the ghosts; then the edge nodes, which are sent as soon as they are complete.
template <std::size_t method>
HWY_INLINE void take_stages_of_part(const SlicedBodies& bodies, std::uint32_t count) {
  NodeMessages& messages = *bodies.messages;
  const auto gathered_in = [&](std::uint32_t number) {
    const Stage& stage = integrators[method].stages[number % integrators[method].stage_count];
    return pairs_in<method>(bodies.base, number)[index(stage.gather)];
  };
  messages.begin(gathered_in(0));
  work_in_phases(
      bodies.chunks.size(), bodies.threads, 2 * count, slice_spins,
      [&](std::uint32_t thread, const ChunkTickets::Ticket& ticket) HWY_ATTR {
        const bool at_edge = ticket.phase % 2 != 0;
        if (!at_edge && thread == 0) messages.advance();  // every few microseconds
        work_on<method>(bodies, ticket.phase / 2,
                        (at_edge ? bodies.edge_chunks : bodies.chunks)[ticket.chunk]);
      },
      [&](std::uint32_t finished) {
        if (finished % 2 != 0)
          messages.finish(gathered_in(finished / 2));
        else if (finished < 2 * count)
          messages.begin(gathered_in(finished / 2));
      });
}

template <std::size_t method>
HWY_INLINE void take_steps(SlicedBodies& bodies, int count) {
  // A node's sums have the order of its entries, whichever thread computes them: the result is the same to
  // the last bit for any number of threads.
  const auto stages =
      static_cast<std::uint32_t>(count) * static_cast<std::uint32_t>(integrators[method].stage_count);
  if (stages == 0 || bodies.chunks.empty()) return;
  if (bodies.messages)
    take_stages_of_part<method>(bodies, stages);
  else
    work_in_phases(
        bodies.chunks.size(), bodies.threads, stages, slice_spins,
        [&](std::uint32_t, const ChunkTickets::Ticket& ticket)
            HWY_ATTR { work_on<method>(bodies, ticket.phase, bodies.chunks[ticket.chunk]); },
        [](std::uint32_t) {});
  if (count % 2 != 0) std::swap(bodies.base[index(Pair::state)], bodies.base[index(Pair::next)]);
}

/// Takes `count` steps of an integrator of `fewest` to `most` stages.
template <std::size_t fewest, std::size_t most>
void step_slices(SlicedBodies& bodies, int count) {
  with_integrator(*bodies.integrator, [&](auto method) HWY_ATTR {
    constexpr std::size_t stages = integrators[method].stage_count;
    if constexpr (stages >= fewest && stages <= most)
      take_in_calls<method>(count, [&](int some) HWY_ATTR { take_steps<method>(bodies, some); });
  });
}

}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
