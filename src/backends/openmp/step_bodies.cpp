// The walks over bodies: over slices, chunk by chunk, and over alike bodies, one per lane, node by node and
// each spring once. Compiled for the integrators of MSSIM_STAGES, in MSSIM_REAL.
#include "backends/vectors/instruction_sets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "backends/openmp/step_bodies.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#include <omp.h>

#include <bit>
#include <cstdint>
#include <utility>

#include "backends/layouts/node_lanes-inl.h"
#include "backends/layouts/records-inl.h"
#include "backends/layouts/sliced_graph.h"
#include "backends/openmp/bodies.h"
#include "backends/threads/chunk_tickets.h"

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {
inline namespace MSSIM_PRECISION {

/// spring_pull (kernels/spring_law.h) between nodes `to_other` apart (m), the other one moving by `closing`
/// relative to this one (m/s). Finite even without a spring, if both ends are the same node: 1e-36 is added
/// to the length squared. Elsewhere that can only decide a tie; a spring of length zero gives no force,
/// whereas serial gives NaN.
HWY_INLINE Lanes body_spring_pull(const Lanes3& to_other, const Lanes3& closing, const SpringLanes& spring) {
  return spring_pull_at(inverse_length(dot_add(to_other, to_other, Lanes(Real{1e-36F}))),
                        dot(closing, to_other), spring);
}

/// The pairs in a stage, counted from the first one of a call: `state` and `next` swap in every step. `base`:
/// those of the first stage.
template <std::size_t method>
HWY_INLINE Pairs pairs_in(const Pairs& base, std::uint32_t stage) {
  Pairs pairs = base;
  if (stage / integrators[method].stage_count % 2 != 0)
    std::swap(pairs[index(Pair::state)], pairs[index(Pair::next)]);
  return pairs;
}

/// Calls act(thread, ticket) for every chunk of `phases` phases, one phase after the other. The thread that
/// finishes phase n calls between(n), while all others wait.
template <class Act, class Between>
HWY_INLINE void work_in_phases(const BodySteps<Real>& bodies, std::uint32_t phases, const Act& act,
                               const Between& between) {
  ChunkTickets tickets(static_cast<std::uint32_t>(bodies.chunks.size()),
                       static_cast<std::uint32_t>(bodies.threads));
  std::uint32_t opened = 1;  // used only by the thread that has finished a phase
  tickets.open();
#pragma omp parallel num_threads(static_cast <int>(bodies.threads))
  {
    const auto thread = static_cast<std::uint32_t>(omp_get_thread_num());
    tickets.work_until_closed(
        thread, bodies.spins, [&](const ChunkTickets::Ticket& ticket) HWY_ATTR { act(thread, ticket); },
        [&] {
          between(opened);
          if (opened == phases) return tickets.close();
          ++opened;
          tickets.open();
        });
  }
}

/// Entries in order, across slices. The records of the next entry are loaded and transposed before the
/// springs of this one are computed: that has a long latency, and a CPU does not look far enough ahead. On an
/// Intel Xeon, one thread, bodies3858 and bodies38233: 0.97 and 0.90 of the time; with AVX2 or SSE4,
/// bodies3858: 0.95 and 0.93.
class EntryWalk {
 public:
  /// `pair`: the gathered one.
  HWY_INLINE EntryWalk(const SlicedBodiesOf<Real>& bodies, const Real* pair, std::size_t first_slice)
      : pair_(pair), entry_(first_entry(bodies, first_slice)), next_(load()) {}

  /// Start of a slice's entries.
  static HWY_INLINE const Real* first_entry(const SlicedBodiesOf<Real>& bodies, std::size_t slice) {
    return bodies.entries.data() + bodies.first_entry[slice] * floats;
  }
  HWY_INLINE bool is_before(const Real* end) const { return entry_ < end; }
  /// SlicedGraph::stiffness_rest of this entry.
  HWY_INLINE Lanes stiffness_rest() const { return hn::Load(RealTag(), entry_ + vector_nodes); }
  /// Returns the neighbours of this entry and advances to the next.
  HWY_INLINE NodeLanes take() {
    const NodeLanes taken = next_;
    entry_ += floats;
    next_ = load();  // slice_entries() has an extra entry after the last one
    return taken;
  }

 private:
  static constexpr std::size_t floats = 2 * vector_nodes;

  HWY_INLINE NodeLanes load() const {
    return load_records<vector_nodes>([&](std::size_t i) MSSIM_INLINE_LAMBDA {
      return pair_ + std::size_t{std::bit_cast<BitsOf<Real>>(entry_[i])} * slice_offset_unit<Real>;
    });
  }

  const Real* const pair_;
  const Real* entry_;
  NodeLanes next_;
};

/// Acceleration of a slice's nodes by their springs, neighbour by neighbour in the order of entries up to
/// `end`.
HWY_INLINE Lanes3 spring_acceleration(EntryWalk& entries, const Real* end, const NodeLanes& node,
                                      const SpringConstants<Lanes>& constants) {
  Lanes3 sum = zero3();
  while (entries.is_before(end)) {
    const Lanes stiffness_rest = entries.stiffness_rest();
    const NodeLanes other = entries.take();
    const Lanes3 to_other = other.x - node.x;
    // An empty entry's pull is finite and its length zero: it gives no force.
    const Lanes pull = body_spring_pull(to_other, other.v - node.v, {constants, stiffness_rest});
    sum = mul_add(pull, to_other, sum);
  }
  return sum;
}

/// One stage at the nodes of one slice.
template <std::size_t method, std::size_t stage>
HWY_INLINE void step_slice(const SlicedBodiesOf<Real>& bodies, const Pairs& base, std::size_t slice,
                           EntryWalk& entries) {
  const std::size_t offset = slice * vector_nodes * record_floats;
  const NodeLanes node = load_nodes(base[index(integrators[method].stages[stage].gather)] + offset);
  const Real* of_slice =
      bodies.constants.data() + slice * SlicedBodiesOf<Real>::slice_constants * vector_nodes;
  const SpringConstants<Lanes> constants = load_constants(of_slice);
  const Mask free = hn::Eq(hn::Load(RealTag(), of_slice), hn::Zero(RealTag()));
  const Lanes3 a = spring_acceleration(entries, EntryWalk::first_entry(bodies, slice + 1), node, constants);
  update_nodes<method, stage>(base, offset, node, a, free, bodies.coefficients, bodies.surroundings);
}

template <std::size_t method, std::size_t stage>
HWY_NOINLINE void step_chunk(const SlicedBodiesOf<Real>& bodies, const Pairs& base, IndexRange chunk,
                             std::uint32_t /*thread*/) {
  EntryWalk entries(bodies, base[index(integrators[method].stages[stage].gather)], chunk.begin);
  for (std::size_t slice = chunk.begin; slice < chunk.end; ++slice)
    step_slice<method, stage>(bodies, base, slice, entries);
}

/// Positions and velocities of a node in all lanes: [x y z u v w][lanes].
HWY_INLINE NodeLanes load_bodies(const Real* from) { return {load3(from), load3(from + 3 * vector_nodes)}; }

/// Adds the forces of springs from earlier pieces to those on a piece's nodes.
HWY_NOINLINE inline void add_cut_springs(const AlikeBodiesOf<Real>& shape,
                                         const BodyLanesOf<Real>::Piece& piece, const Real* gathered,
                                         Real* forces) {
  const SpringConstants<Lanes> constants = in_every_lane(shape.constants);
  for (const BodyLanesOf<Real>::CutSpring& cut : piece.cut) {
    const NodeLanes first = load_bodies(gathered + 2 * std::size_t{cut.first});
    const NodeLanes second = load_bodies(gathered + 2 * std::size_t{cut.second});
    const Lanes3 to_other = second.x - first.x;
    const Lanes pull = body_spring_pull(to_other, second.v - first.v, {constants, Lanes(cut.stiffness_rest)});
    Real* const force = forces + cut.second;
    store3(force, mul_add(-pull, to_other, load3(force)));
  }
}

/// One stage at the nodes of a piece. `forces` must be zero, and is zero afterwards.
template <std::size_t method, std::size_t stage>
HWY_NOINLINE void step_piece(const BodyLanesOf<Real>& bodies, const Pairs& base,
                             const BodyLanesOf<Real>::Piece& piece, Real* const forces) {
  constexpr std::size_t force_floats = 3 * vector_nodes;
  const AlikeBodiesOf<Real>& shape = bodies.shapes[piece.shape];
  const SpringConstants<Lanes> constants = in_every_lane(shape.constants);
  // Copies, because the compiler must assume that a vector store may change any object in memory.
  const Coefficients<Real> coefficients = bodies.coefficients;
  const SurroundingsOf<Real> surroundings = bodies.surroundings;
  const std::size_t end = piece.end, reach = piece.reach;
  const std::uint32_t* const first_spring = shape.first_spring.data();
  const std::uint8_t* const pinned = shape.pinned.data();
  const AlikeBodiesOf<Real>::SpringAhead* const all = shape.springs.data();
  Pairs pairs = base;
  for (Real*& pair : pairs)
    if (pair != nullptr) pair += piece.offset;
  const Real* const gathered = pairs[index(integrators[method].stages[stage].gather)];

  add_cut_springs(shape, piece, gathered, forces);
  for (std::size_t node = piece.begin; node < end; ++node) {
    const std::size_t offset = node * force_floats;
    const NodeLanes here = load_bodies(gathered + 2 * offset);
    Lanes3 sum = load3(forces + offset);
    store3(forces + offset, zero3());
    const AlikeBodiesOf<Real>::SpringAhead* const last = all + first_spring[node + 1];
    for (const AlikeBodiesOf<Real>::SpringAhead* spring = all + first_spring[node]; spring < last; ++spring) {
      const NodeLanes other = load_bodies(gathered + 2 * std::size_t{spring->other});
      const Lanes3 to_other = other.x - here.x;
      const Lanes pull =
          body_spring_pull(to_other, other.v - here.v, {constants, Lanes(spring->stiffness_rest)});
      Real* const force = forces + spring->other;
      store3(force, mul_add(-pull, to_other, load3(force)));
      sum = mul_add(pull, to_other, sum);
    }
    const Mask free = hn::FirstN(RealTag(), pinned[node] != 0 ? 0 : vector_nodes);
    const auto at = [&](auto slot) MSSIM_INLINE_LAMBDA {
      constexpr std::size_t number = index(decltype(slot)::value);
      return pairs[number / 2] + 2 * offset + number % 2 * force_floats;
    };
    update_lanes<method, stage>(
        here, sum, free, Lanes(surroundings.gravity), coefficients, surroundings,
        [&](auto slot) MSSIM_INLINE_LAMBDA { return load3(at(slot)); },
        [&](auto slot, const Lanes3& value) MSSIM_INLINE_LAMBDA { store3(at(slot), value); });
  }
  for (std::size_t node = end; node < reach; ++node) store3(forces + node * force_floats, zero3());
}

template <std::size_t method, std::size_t stage>
HWY_INLINE void step_chunk(BodyLanesOf<Real>& bodies, const Pairs& base, IndexRange chunk,
                           std::uint32_t thread) {
  for (std::size_t piece = chunk.begin; piece < chunk.end; ++piece)
    step_piece<method, stage>(bodies, base, bodies.pieces[piece], bodies.forces[thread].data());
}

/// A thread's work on a chunk in a stage, counted from the first one of the call.
template <std::size_t method, class Bodies>
HWY_INLINE void work_on(Bodies& bodies, std::uint32_t number, IndexRange chunk, std::uint32_t thread) {
  const Pairs base = pairs_in<method>(bodies.base, number);
  for_each_stage<method>([&](auto stage) HWY_ATTR {
    if (number % integrators[method].stage_count == stage)
      step_chunk<method, stage>(bodies, base, chunk, thread);
  });
}

/// Executes `stages` stages.
template <std::size_t method, class Bodies>
HWY_INLINE void take_stages(Bodies& bodies, std::uint32_t count) {
  work_in_phases(
      bodies, count,
      [&](std::uint32_t thread, const ChunkTickets::Ticket& ticket)
          HWY_ATTR { work_on<method>(bodies, ticket.phase, bodies.chunks[ticket.chunk], thread); },
      [](std::uint32_t) {});
}

/// Each stage of a part has two phases: nodes without ghost neighbours are stepped while messages bring the
/// ghosts; then the edge nodes, which are sent as soon as they are complete.
template <std::size_t method>
HWY_INLINE void take_stages(SlicedBodiesOf<Real>& bodies, std::uint32_t count) {
  if (bodies.messages == nullptr) return take_stages<method, SlicedBodiesOf<Real>>(bodies, count);
  NodeMessages<Real>& messages = *bodies.messages;
  const auto gathered_in = [&](std::uint32_t number) {
    const Stage& stage = integrators[method].stages[number % integrators[method].stage_count];
    return pairs_in<method>(bodies.base, number)[index(stage.gather)];
  };
  messages.begin(gathered_in(0));
  work_in_phases(
      bodies, 2 * count,
      [&](std::uint32_t thread, const ChunkTickets::Ticket& ticket) HWY_ATTR {
        const bool at_edge = ticket.phase % 2 != 0;
        if (!at_edge && thread == 0) messages.advance();  // every few microseconds
        work_on<method>(bodies, ticket.phase / 2,
                        (at_edge ? bodies.edge_chunks : bodies.chunks)[ticket.chunk], thread);
      },
      [&](std::uint32_t finished) {
        if (finished % 2 != 0)
          messages.finish(gathered_in(finished / 2));
        else if (finished < 2 * count)
          messages.begin(gathered_in(finished / 2));
      });
}

template <std::size_t method, class Bodies>
HWY_INLINE void take_steps(Bodies& bodies, int count) {
  // A node's sums are in the order of its neighbours, on any thread and for any division of bodies: the
  // result is bitwise identical for any number of threads.
  const auto stages =
      static_cast<std::uint32_t>(count) * static_cast<std::uint32_t>(integrators[method].stage_count);
  if (stages == 0 || bodies.chunks.empty()) return;
  take_stages<method>(bodies, stages);
  if (count % 2 != 0) std::swap(bodies.base[index(Pair::state)], bodies.base[index(Pair::next)]);
}

/// Takes `count` steps of an integrator of these Stages.
template <std::size_t stages, class Bodies>
void step_bodies(Bodies& bodies, int count) {
  with_integrator(*bodies.integrator, [&](auto method) HWY_ATTR {
    if constexpr (Stages<stages>::have(integrators[method])) {
      const auto take = [&](int some) HWY_ATTR { take_steps<method>(bodies, some); };
      constexpr int most = 1 << 20;  // a ticket numbers a call's phases; a stage may have two
      static_assert(2 * most * integrators[method].stage_count <= ChunkTickets::most_phases);
      for (; count > most; count -= most) take(most);
      take(count);
    }
  });
}

namespace {
StepKernel<SlicedBodiesOf<Real>> slice_kernel() {
  return kernel_here(&step_bodies<MSSIM_STAGES, SlicedBodiesOf<Real>>);
}
StepKernel<BodyLanesOf<Real>> body_lanes_kernel() {
  return kernel_here(&step_bodies<MSSIM_STAGES, BodyLanesOf<Real>>);
}
}  // namespace

}  // namespace MSSIM_PRECISION
}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mssim {
MSSIM_COMPILED_KERNELS(SlicedBodiesOf<MSSIM_REAL>, slice_kernel)
MSSIM_COMPILED_KERNELS(BodyLanesOf<MSSIM_REAL>, body_lanes_kernel)
}  // namespace mssim
#endif
