// The row `wasm` of the page of `mssim web`: the plain list of springs as a WebAssembly module in single
// precision, four springs at a time. The page puts a scene into its memory (WasmBackend in
// src/web/browser/simulate.js). A program of its own, without a C library: CMakeLists.txt compiles it.

#include <cstdint>

#include "integrators/coefficients.h"
#include "kernels/spring_constants.h"

namespace mssim {
namespace {

/// A number of each of four springs, or a vector in space, whose fourth number is 0.
using Four = float __attribute__((ext_vector_type(4)));

// What the texts of kernels/ need, for a node's floats and for four springs.
float inverse_sqrt(float a) { return 1 / __builtin_sqrtf(a); }
Four inverse_sqrt(Four a) { return 1 / __builtin_wasm_sqrt_f32x4(a); }
template <class Factor, class Number>
Number mul_add(Factor a, Number b, Number c) {
  return a * b + c;
}
float where_less(float a, float b, float yes, float no) { return a < b ? yes : no; }
float dot(Four a, Four b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

#define MSSIM_LAW_INLINE inline
#include "laws/laws-inl.h"

#define MSSIM_INLINE [[gnu::always_inline]] inline
#define MSSIM_INLINE_LAMBDA __attribute__((always_inline))
#include "integrators/stage_update-inl.h"

struct Node {
  Four x, v;  // m, m/s
};

/// Four springs of the list side by side. The page fills the last ones with springs that pull at nothing.
struct Springs {
  std::array<std::uint32_t, 4> first, second;
  LinearSpring<Four> law;
};

/// A system, and where the page finds its parts; all numbers of the head have four bytes.
struct List {
  std::array<Node*, pair_kinds> pairs;
  Springs* springs;
  float* inverse_mass;  // 1/kg; 0 for a pinned node
  Four* force;          // N
  std::uint32_t nodes, fours;
  float viscous_damping, gravity, height, restitution, friction;
  const Integrator* integrator;
  Coefficients<float> coefficients;
} list;

void add_forces(const Node* from) {
  for (std::uint32_t node = 0; node < list.nodes; ++node) list.force[node] = 0;
  for (std::uint32_t s = 0; s < list.fours; ++s) {
    const Springs& springs = list.springs[s];
    Four d[4], u[4];
    for (std::size_t i = 0; i < 4; ++i) {
      const Node &one = from[springs.first[i]], &other = from[springs.second[i]];
      d[i] = other.x - one.x;
      u[i] = other.v - one.v;
    }
    const auto column = [](const Four(&row)[4], auto c) {
      return Four{row[0][c], row[1][c], row[2][c], row[3][c]};
    };
    const Four x = column(d, 0), y = column(d, 1), z = column(d, 2);
    const Four closing = column(u, 0) * x + column(u, 1) * y + column(u, 2) * z;
    const Four pull = spring_pull(x * x + y * y + z * z, closing, springs.law);
    for (std::size_t i = 0; i < 4; ++i) {
      const Four force = pull[i] * d[i];
      list.force[springs.first[i]] += force;
      list.force[springs.second[i]] -= force;
    }
  }
}

template <std::size_t method, std::size_t stage>
void update_nodes() {
  const Node* from = list.pairs[index(integrators[method].stages[stage].gather)];
  for (std::uint32_t i = 0; i < list.nodes; ++i) {
    if (list.inverse_mass[i] == 0) continue;
    const Node node = from[i];
    const Four a =
        node_acceleration(list.inverse_mass[i] * list.force[i], node.v, list.viscous_damping, list.gravity);
    const auto slot_of = [&](auto slot) -> Four& {
      constexpr std::size_t s = index(decltype(slot)::value);
      return s % 2 == 0 ? list.pairs[s / 2][i].x : list.pairs[s / 2][i].v;
    };
    update_stage<method, stage>(
        list.coefficients, node.x, node.v, a, slot_of, [&](auto slot, Four value) { slot_of(slot) = value; },
        [&](Four& x, Four& v) {
          if (!(x.y < list.height)) return;
          x.y = list.height;
          v = floor_velocity(v, list.restitution, list.friction);
        });
  }
}

extern "C" unsigned char __heap_base;  // the linker's: the first byte after the program's own memory

/// Takes memory from there on, one part after the other.
class Room {
 public:
  template <class Part>
  Part* take(std::uint32_t count) {
    const std::uint64_t begin = end_;
    end_ += (std::uint64_t{count} * sizeof(Part) + 15) / 16 * 16;  // what vectors need
    return reinterpret_cast<Part*>(static_cast<std::uintptr_t>(begin));
  }
  /// Asks the browser for what was taken.
  bool is_there() const {
    constexpr std::uint64_t page = 65536, most = 65536;
    const std::uint64_t pages = (end_ + page - 1) / page;
    const std::size_t has = __builtin_wasm_memory_size(0);
    return pages <= has || (pages <= most &&
                            __builtin_wasm_memory_grow(0, static_cast<std::size_t>(pages) - has) != SIZE_MAX);
  }

 private:
  std::uint64_t end_ = (reinterpret_cast<std::uintptr_t>(&__heap_base) + 15) / 16 * 16;
};

}  // namespace

extern "C" {
/// Makes room for a system after the program's own memory. `integrator`: of all_integrators. Returns the
/// list's address, or 0 if the browser gives no memory.
__attribute__((export_name("prepare"))) List* prepare(std::uint32_t integrator, double dt_s,
                                                      std::uint32_t nodes, std::uint32_t springs,
                                                      float viscous_damping, float gravity, float height,
                                                      float restitution, float friction) {
  list.integrator = all_integrators[integrator];
  list.coefficients = coefficients_of<float>(*list.integrator, dt_s);
  list.nodes = nodes;
  list.fours = (springs + 3) / 4;
  list.viscous_damping = viscous_damping;
  list.gravity = gravity;
  list.height = height;
  list.restitution = restitution;
  list.friction = friction;
  Room room;
  for (std::size_t pair = 0; pair < pair_kinds; ++pair)
    if (touches(*list.integrator, static_cast<Pair>(pair))) list.pairs[pair] = room.take<Node>(nodes);
  list.springs = room.take<Springs>(list.fours);
  list.inverse_mass = room.take<float>(nodes);
  list.force = room.take<Four>(nodes);
  return room.is_there() ? &list : nullptr;
}

__attribute__((export_name("step"))) void step(std::uint32_t count) {
  with_integrator(*list.integrator, [&](auto method) {
    for (std::uint32_t step = 0; step < count; ++step) {
      for_each_stage<method>([&](auto stage) {
        add_forces(list.pairs[index(integrators[method].stages[stage].gather)]);
        update_nodes<method, stage>();
      });
      std::swap(list.pairs[index(Pair::state)], list.pairs[index(Pair::next)]);
    }
  });
}
}

}  // namespace mssim
