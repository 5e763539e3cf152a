// The walk over alike bodies, one a lane: node by node, each spring once. Compiled once per instruction set,
// so the guard toggles.
#if defined(MSSIM_BODY_LANE_STEPS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MSSIM_BODY_LANE_STEPS_INL_H_
#undef MSSIM_BODY_LANE_STEPS_INL_H_
#else
#define MSSIM_BODY_LANE_STEPS_INL_H_
#endif

#include "backends/layouts/update_lanes-inl.h"
#include "backends/openmp/body_lanes.h"
#include "backends/openmp/body_spring-inl.h"
#include "backends/openmp/chunk_phases-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {

/// Positions and velocities of a node in all lanes: [x y z u v w][lanes].
HWY_INLINE NodeLanes load_bodies(const float* from) { return {load3(from), load3(from + 3 * vector_nodes)}; }

/// Adds to the forces on a piece's nodes those of springs from nodes before it.
HWY_NOINLINE inline void add_cut_springs(const BodyLanes::Shape& shape, const BodyLanes::Piece& piece,
                                         const float* gathered, float* forces) {
  const Lanes stiffness(shape.stiffness), damping(shape.damping);
  for (const BodyLanes::CutSpring& cut : piece.cut) {
    const NodeLanes first = load_bodies(gathered + 2 * std::size_t{cut.first});
    const NodeLanes second = load_bodies(gathered + 2 * std::size_t{cut.second});
    const Lanes3 to_other = second.x - first.x;
    const Lanes pull =
        body_spring_pull(to_other, second.v - first.v, {stiffness, Lanes(cut.stiffness_rest), damping});
    float* const force = forces + cut.second;
    store3(force, mul_add(-pull, to_other, load3(force)));
  }
}

/// One stage at the nodes of a piece. `forces` are zero, and are zero again afterwards.
template <std::size_t method, std::size_t stage>
HWY_NOINLINE void step_piece(const BodyLanes& bodies, const Pairs& base, const BodyLanes::Piece& piece,
                             float* const forces) {
  constexpr std::size_t force_floats = 3 * vector_nodes;
  const BodyLanes::Shape& shape = bodies.shapes[piece.shape];
  const Lanes stiffness(shape.stiffness), damping(shape.damping);
  // Copies: a vector's store may change all else, as far as the compiler knows.
  const Coefficients<float> coefficients = bodies.coefficients;
  const Surroundings surroundings = bodies.surroundings;
  const std::size_t end = piece.end, reach = piece.reach;
  const std::uint32_t* const first_spring = shape.first_spring.data();
  const std::uint8_t* const pinned = shape.pinned.data();
  const BodyLanes::Shape::Spring* const all = shape.springs.data();
  Pairs pairs = base;
  for (float*& pair : pairs)
    if (pair != nullptr) pair += piece.offset;
  const float* const gathered = pairs[index(integrators[method].stages[stage].gather)];

  add_cut_springs(shape, piece, gathered, forces);
  for (std::size_t node = piece.begin; node < end; ++node) {
    const std::size_t offset = node * force_floats;
    const NodeLanes here = load_bodies(gathered + 2 * offset);
    Lanes3 sum = load3(forces + offset);
    store3(forces + offset, zero3());
    const BodyLanes::Shape::Spring* const last = all + first_spring[node + 1];
    for (const BodyLanes::Shape::Spring* spring = all + first_spring[node]; spring < last; ++spring) {
      const NodeLanes other = load_bodies(gathered + 2 * std::size_t{spring->other});
      const Lanes3 to_other = other.x - here.x;
      const Lanes pull =
          body_spring_pull(to_other, other.v - here.v, {stiffness, Lanes(spring->stiffness_rest), damping});
      float* const force = forces + spring->other;
      store3(force, mul_add(-pull, to_other, load3(force)));
      sum = mul_add(pull, to_other, sum);
    }
    const Mask free = hn::FirstN(FloatTag(), pinned[node] != 0 ? 0 : vector_nodes);
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

template <std::size_t method>
HWY_INLINE void take_steps_of_lanes(BodyLanes& bodies, int count) {
  const auto stages =
      static_cast<std::uint32_t>(count) * static_cast<std::uint32_t>(integrators[method].stage_count);
  if (stages == 0 || bodies.chunks.empty()) return;
  // A node's sums have the order of its neighbours, wherever bodies are cut: the result is the same to the
  // last bit for any number of threads.
  work_in_phases(
      bodies.chunks.size(), bodies.threads, stages, bodies.spins,
      [&](std::uint32_t thread, const ChunkTickets::Ticket& ticket) HWY_ATTR {
        const Pairs base = pairs_in<method>(bodies.base, ticket.phase);
        const BodyLanes::Chunk chunk = bodies.chunks[ticket.chunk];
        for_each_stage<method>([&](auto stage) HWY_ATTR {
          if (ticket.phase % integrators[method].stage_count != stage) return;
          for (std::size_t piece = chunk.begin; piece < chunk.end; ++piece)
            step_piece<method, stage>(bodies, base, bodies.pieces[piece], bodies.forces[thread].data());
        });
      },
      [](std::uint32_t) {});
  if (count % 2 != 0) std::swap(bodies.base[index(Pair::state)], bodies.base[index(Pair::next)]);
}

/// Takes `count` steps.
inline void step_body_lanes(BodyLanes& bodies, int count) {
  with_integrator(*bodies.integrator, [&](auto method) HWY_ATTR {
    take_in_calls<method>(count, [&](int some) HWY_ATTR { take_steps_of_lanes<method>(bodies, some); });
  });
}

}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
