#include "backends/accumulation/accumulation_methods.h"

#include <array>
#include <atomic>
#include <cstddef>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "backends/accumulation/gather_vectors.h"
#include "backends/layouts/spring_graph.h"
#include "backends/spring_list/list_backends.h"
#include "backends/spring_list/list_method.h"

namespace mssim {
namespace {

/// A spinlock of one byte: the guarded work, three additions, is done before a thread could be put to sleep,
/// and a std::mutex would take 40 bytes per node of 24. Two threads rarely meet at a node, but the holder may
/// be interrupted while another process has its core, hence the yield.
class ByteLock {
 public:
  void lock() {
    while (taken_.test_and_set(std::memory_order_acquire))
      while (taken_.test(std::memory_order_relaxed)) std::this_thread::yield();
  }
  void unlock() { taken_.clear(std::memory_order_release); }

 private:
  std::atomic_flag taken_;
};

class LockPerNode : public AddingAccumulation {
 public:
  LockPerNode(SpringList<float>& list, std::size_t threads)
      : AddingAccumulation(list, threads), locks_(list.nodes()) {}

  void add(const Team& team, Pair gather) {
    for (const Spring& spring : team.slice_of(list_.springs())) {
      const Vec3<float> force = list_.force_of(spring, gather);
      {
        const std::lock_guard lock(locks_[spring.first]);
        list_.force(spring.first) += force;
      }
      const std::lock_guard lock(locks_[spring.second]);
      list_.force(spring.second) -= force;
    }
  }

 private:
  std::vector<ByteLock> locks_;  // [nodes]
};

/// CPUs add integers atomically, but not floats: this is a compare-exchange loop.
void add_atomically(Vec3<float>& sum, const Vec3<float>& force) {
  std::atomic_ref(sum.x).fetch_add(force.x, std::memory_order_relaxed);
  std::atomic_ref(sum.y).fetch_add(force.y, std::memory_order_relaxed);
  std::atomic_ref(sum.z).fetch_add(force.z, std::memory_order_relaxed);
}

class Atomic : public AddingAccumulation {
 public:
  using AddingAccumulation::AddingAccumulation;

  void add(const Team& team, Pair gather) {
    for (const Spring& spring : team.slice_of(list_.springs())) {
      const Vec3<float> force = list_.force_of(spring, gather);
      add_atomically(list_.force(spring.first), force);
      add_atomically(list_.force(spring.second), -1.0F * force);
    }
  }
};

class ThreadPrivate : public Accumulation {
 public:
  ThreadPrivate(SpringList<float>& list, std::size_t threads)
      : Accumulation(list, threads), forces_(threads, std::vector<Vec3<float>>(list.nodes())) {}

  void add(const Team& team, Pair gather) {
    std::vector<Vec3<float>>& forces = forces_[team.thread];
    for (const Spring& spring : team.slice_of(list_.springs())) {
      const Vec3<float> force = list_.force_of(spring, gather);
      forces[spring.first] += force;
      forces[spring.second] -= force;
    }
  }

  void finish(const Team& team) {
    for (std::size_t node = team.begin(list_.nodes()); node < team.end(list_.nodes()); ++node) {
      Vec3<float> sum;
      for (std::size_t thread = 0; thread < team.threads; ++thread) {
        sum += forces_[thread][node];
        forces_[thread][node] = {};  // cleared for the next stage: its owner may not, while others still sum
      }
      list_.force(node) = sum;
    }
  }

 private:
  std::vector<std::vector<Vec3<float>>> forces_;  // [threads][nodes] N, zero between stages
};

class Colouring : public AddingAccumulation {
 public:
  Colouring(SpringList<float>& list, std::size_t threads)
      : AddingAccumulation(list, threads), colouring_(colour_springs(list.springs(), list.nodes())) {}

  void add(const Team& team, Pair gather) {
    for (std::size_t colour = 0; colour < colouring_.groups(); ++colour) {
      if (colour > 0) team.meet();
      for (const Spring& spring : team.slice_of(colouring_.of(colour)))
        list_.add_force(spring, list_.force_of(spring, gather));
    }
  }

 private:
  SpringColouring colouring_;
};

class Gather : public Accumulation {
 public:
  Gather(SpringList<float>& list, std::size_t threads)
      : Accumulation(list, threads), springs_(list.nodes(), [&](const auto& visit) {
          for (Spring spring : list.springs()) {
            visit(spring.first, spring);
            std::swap(spring.first, spring.second);
            visit(spring.first, spring);
          }
        }) {}

  void add(const Team& team, Pair gather) {
    for (std::size_t node = team.begin(list_.nodes()); node < team.end(list_.nodes()); ++node) {
      Vec3<float> sum;
      for (const Spring& spring : springs_.of(node)) sum += list_.force_of(spring, gather);
      list_.force(node) = sum;
    }
  }

 private:
  Grouped<Spring, std::size_t> springs_;  // by node, each spring twice, with the node as first end
};

constexpr MemoryUse with_private_arrays{.node = 17, .pair_node = 24, .thread_node = 12};
constexpr MemoryUse with_coloured_copy{.node = 25, .pair_node = 24, .spring = 20};
constexpr MemoryUse with_both_ends{.node = 33, .pair_node = 24, .spring = 32};
constexpr MemoryUse in_padded_rows{.pair_node = 24, .storage = Storage::separate};

/// A method that uses the plain list.
constexpr AccumulationMethod of_list(std::string_view name, std::string_view description, BackendMaker* make,
                                     const MemoryUse& memory, std::string_view extra_memory,
                                     std::string_view springs_computed, Repeatable repeatable) {
  return {{.name = name,
           .description = description,
           .makes_threads = true,
           .make = make,
           .grid_memory = memory,
           .mesh_memory = memory},
          extra_memory,
          springs_computed,
          repeatable};
}

}  // namespace

std::string_view name_of(Repeatable repeatable) {
  constexpr std::array<std::string_view, 3> names{"no", "at the same number of threads", "yes"};
  return names.at(static_cast<std::size_t>(repeatable));
}

std::span<const AccumulationMethod> accumulation_methods() {
  static const std::array<AccumulationMethod, 9> rows{{
      {baseline_backend(), "none", "once", Repeatable::always},
      of_list("mutex-per-group",
              "one lock for all nodes, taken to add the forces of 512 springs (threads-mutex)",
              make_threads_mutex, spring_list_memory, "6 KiB a thread", "once", Repeatable::never),
      of_list("lock-per-node", "a spinning lock of one byte a node, taken for each end of a spring",
              make_list_method<LockPerNode>, spring_list_memory, "1 byte a node", "once", Repeatable::never),
      of_list("atomic", "atomic additions, three for each end of a spring", make_list_method<Atomic>,
              spring_list_memory, "none", "once", Repeatable::never),
      of_list("thread-private", "an array of forces for each thread, summed afterwards",
              make_list_method<ThreadPrivate>, with_private_arrays, "12 bytes a node and thread", "once",
              Repeatable::at_same_threads),
      of_list("colouring", "springs of one colour share no node; the threads meet after each colour",
              make_list_method<Colouring>, with_coloured_copy, "16 bytes a spring", "once",
              Repeatable::always),
      of_list("gather", "each node sums its own springs", make_list_method<Gather>, with_both_ends,
              "32 bytes a spring, 8 a node", "twice", Repeatable::always),
      {{.name = "gather-vectors",
        .description = "vectors of a cloth's nodes sum their own springs, from rows of a layout of its own",
        .makes_threads = true,
        .make = make_gather_vectors,
        .grid_memory = in_padded_rows,
        .has_vectors = true},
       "a layout of its own",
       "twice",
       Repeatable::always},
      {best_host_backend(), "a layout of its own", "once, but twice on bodies that differ",
       Repeatable::always},
  }};
  return rows;
}

}  // namespace mssim
