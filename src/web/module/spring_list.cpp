// The rows `wasm` and `wasm-threads` of the page of `mssim web`: the plain list of springs as a WebAssembly
// module in single precision, four springs at a time. The page puts a scene into its memory (WasmBackend in
// src/web/browser/simulate.js). A program of its own, without a C library: cmake/wasm_module.cmake compiles
// it for one thread, and for threads that share a memory. A thread owns a range of nodes. It has all springs
// that pull at them, so those between two ranges are computed twice, and no thread writes what another
// writes.

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

/// What a thread has. It owns the nodes [begin, end); its springs touch nodes of [low, high).
struct Share {
  Springs* springs;
  std::uint32_t fours, begin, end, low, high;
  Four* force;  // N, of [low, high); only those of its own nodes are whole
};

using Pairs = std::array<Node*, pair_kinds>;

/// A system, and where the page finds its parts; all numbers of the head have four bytes.
struct List {
  Pairs pairs;
  float* inverse_mass;  // 1/kg; 0 for a pinned node
  Share* shares;
  std::uint32_t threads;
  float viscous_damping, gravity, height, restitution, friction;
  const Integrator* integrator;
  Coefficients<float> coefficients;
} list;

void add_forces(const Share& share, const Node* from) {
  Four* const force = share.force - share.low;
  for (std::uint32_t node = share.low; node < share.high; ++node) force[node] = 0;
  for (std::uint32_t s = 0; s < share.fours; ++s) {
    const Springs& springs = share.springs[s];
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
      const Four at_one = pull[i] * d[i];
      force[springs.first[i]] += at_one;
      force[springs.second[i]] -= at_one;
    }
  }
}

template <std::size_t method, std::size_t stage>
void update_nodes(const Share& share, const Pairs& pairs) {
  const Node* from = pairs[index(integrators[method].stages[stage].gather)];
  for (std::uint32_t i = share.begin; i < share.end; ++i) {
    if (list.inverse_mass[i] == 0) continue;
    const Node node = from[i];
    const Four a = node_acceleration(list.inverse_mass[i] * share.force[i - share.low], node.v,
                                     list.viscous_damping, list.gravity);
    const auto slot_of = [&](auto slot) -> Four& {
      constexpr std::size_t s = index(decltype(slot)::value);
      return s % 2 == 0 ? pairs[s / 2][i].x : pairs[s / 2][i].v;
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

/// Waits until all threads are here. They look a million times before they sleep, because to wake takes
/// longer than a stage of a small scene. A thread that never slept could hold the processor of the one that
/// it waits for.
[[gnu::noinline]] void wait_for_all() {
#ifdef __wasm_atomics__
  static std::uint32_t here, round;
  constexpr int most_looks = 1'000'000;
  const std::uint32_t now = __atomic_load_n(&round, __ATOMIC_SEQ_CST);
  if (__atomic_add_fetch(&here, 1, __ATOMIC_SEQ_CST) == list.threads) {
    __atomic_store_n(&here, 0, __ATOMIC_SEQ_CST);
    __atomic_add_fetch(&round, 1, __ATOMIC_SEQ_CST);
    __builtin_wasm_memory_atomic_notify(reinterpret_cast<int*>(&round), list.threads);
    return;
  }
  for (int look = 0; look < most_looks; ++look)
    if (__atomic_load_n(&round, __ATOMIC_SEQ_CST) != now) return;
  while (__atomic_load_n(&round, __ATOMIC_SEQ_CST) == now)
    __builtin_wasm_memory_atomic_wait32(reinterpret_cast<int*>(&round), static_cast<int>(now), -1);
#endif
}

extern "C" unsigned char __heap_base;  // the linker's: the first byte after the program's own memory

/// Takes memory from there on, one part after the other.
class Room {
 public:
  void clear() { end_ = (reinterpret_cast<std::uintptr_t>(&__heap_base) + 15) / 16 * 16; }
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
  std::uint64_t end_ = 0;
} room;

}  // namespace

extern "C" {
/// Makes room for a system after the program's own memory. `integrator`: of all_integrators. Returns the
/// list's address, or 0 if the browser gives no memory.
__attribute__((export_name("prepare"))) List* prepare(std::uint32_t integrator, double dt_s,
                                                      std::uint32_t nodes, std::uint32_t threads,
                                                      float viscous_damping, float gravity, float height,
                                                      float restitution, float friction) {
  list.integrator = all_integrators[integrator];
  list.coefficients = coefficients_of<float>(*list.integrator, dt_s);
  list.threads = threads;
  list.viscous_damping = viscous_damping;
  list.gravity = gravity;
  list.height = height;
  list.restitution = restitution;
  list.friction = friction;
  room.clear();
  for (std::size_t pair = 0; pair < pair_kinds; ++pair)
    if (touches(*list.integrator, static_cast<Pair>(pair))) list.pairs[pair] = room.take<Node>(nodes);
  list.inverse_mass = room.take<float>(nodes);
  list.shares = room.take<Share>(threads);
  return room.is_there() ? &list : nullptr;
}

/// Makes room for a thread's share. Returns the address of its springs, or 0 if the browser gives no memory.
__attribute__((export_name("share"))) Springs* share(std::uint32_t thread, std::uint32_t springs,
                                                     std::uint32_t begin, std::uint32_t end,
                                                     std::uint32_t low, std::uint32_t high) {
  const std::uint32_t fours = (springs + 3) / 4;
  Springs* const its = room.take<Springs>(fours);
  Four* const force = room.take<Four>(high - low);
  if (!room.is_there()) return nullptr;
  list.shares[thread] = {its, fours, begin, end, low, high, force};
  return its;
}

/// Makes room for a worker's stack. Returns its upper end, or 0 if the browser gives no memory.
__attribute__((export_name("stack"))) unsigned char* stack() {
  constexpr std::uint32_t bytes = 65536;
  unsigned char* const begin = room.take<unsigned char>(bytes);
  return room.is_there() ? begin + bytes : nullptr;
}

/// A thread's part of the steps. It returns when all threads are done.
__attribute__((export_name("step"))) void step(std::uint32_t thread, std::uint32_t count) {
  const Share its = list.shares[thread];
  Pairs pairs = list.pairs;
  with_integrator(*list.integrator, [&](auto method) {
    for (std::uint32_t step = 0; step < count; ++step) {
      for_each_stage<method>([&](auto stage) {
        add_forces(its, pairs[index(integrators[method].stages[stage].gather)]);
        update_nodes<method, stage>(its, pairs);
        wait_for_all();  // no stage writes the pair that it gathers: once a stage is enough
      });
      std::swap(pairs[index(Pair::state)], pairs[index(Pair::next)]);
    }
  });
  if (thread == 0) list.pairs = pairs;
}
}

}  // namespace mssim
