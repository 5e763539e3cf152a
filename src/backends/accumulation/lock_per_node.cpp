#include <atomic>
#include <mutex>
#include <thread>
#include <vector>

#include "backends/accumulation/list_method.h"
#include "backends/accumulation/methods.h"

namespace mssim {
namespace {

/// A lock of one byte that spins: what it guards, three additions, is over before a thread could be put to
/// sleep, and a std::mutex would take 40 bytes where a node has 24. Two threads rarely meet at a node, but
/// one may hold a lock while another process has its core, hence the yield.
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

class LockPerNode {
 public:
  LockPerNode(const System& system, SpringList<float>& list, std::size_t /*threads*/)
      : list_(list), locks_(system.nodes()) {}

  void prepare(const Team& team) { list_.clear_forces(team.begin(list_.nodes()), team.end(list_.nodes())); }

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

  void finish(const Team& /*team*/) {}

 private:
  SpringList<float>& list_;
  std::vector<ByteLock> locks_;  // [nodes]
};

}  // namespace

std::unique_ptr<Backend> make_lock_per_node(const System& system, const Integrator& integrator, double dt_s,
                                            const ExecutionOptions& options) {
  return make_list_method<LockPerNode>(system, integrator, dt_s, options);
}

}  // namespace mssim
