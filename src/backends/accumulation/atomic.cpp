#include <atomic>

#include "backends/accumulation/list_method.h"
#include "backends/accumulation/methods.h"

namespace mssim {
namespace {

/// Processors add integers atomically, not floats: this is a loop of compare and exchange.
void add_atomically(Vec3<float>& sum, const Vec3<float>& force) {
  std::atomic_ref(sum.x).fetch_add(force.x, std::memory_order_relaxed);
  std::atomic_ref(sum.y).fetch_add(force.y, std::memory_order_relaxed);
  std::atomic_ref(sum.z).fetch_add(force.z, std::memory_order_relaxed);
}

class Atomic {
 public:
  Atomic(const System& /*system*/, SpringList<float>& list, std::size_t /*threads*/) : list_(list) {}

  void prepare(const Team& team) { list_.clear_forces(team.begin(list_.nodes()), team.end(list_.nodes())); }

  void add(const Team& team, Pair gather) {
    for (const Spring& spring : team.slice_of(list_.springs())) {
      const Vec3<float> force = list_.force_of(spring, gather);
      add_atomically(list_.force(spring.first), force);
      add_atomically(list_.force(spring.second), -1.0F * force);
    }
  }

  void finish(const Team& /*team*/) {}

 private:
  SpringList<float>& list_;
};

}  // namespace

std::unique_ptr<Backend> make_atomic(const System& system, const Integrator& integrator, double dt_s,
                                     const ExecutionOptions& options) {
  return make_list_method<Atomic>(system, integrator, dt_s, options);
}

}  // namespace mssim
