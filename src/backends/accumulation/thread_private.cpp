#include <vector>

#include "backends/accumulation/list_method.h"
#include "backends/accumulation/methods.h"

namespace mssim {
namespace {

class ThreadPrivate {
 public:
  ThreadPrivate(const System& system, SpringList<float>& list, std::size_t threads)
      : list_(list), forces_(threads, std::vector<Vec3<float>>(system.nodes())) {}

  void prepare(const Team& /*team*/) {}

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
        forces_[thread][node] = {};  // for the next stage: its owner may not, while others still sum
      }
      list_.force(node) = sum;
    }
  }

 private:
  SpringList<float>& list_;
  std::vector<std::vector<Vec3<float>>> forces_;  // [threads][nodes] N, zero between stages
};

}  // namespace

std::unique_ptr<Backend> make_thread_private(const System& system, const Integrator& integrator, double dt_s,
                                             const ExecutionOptions& options) {
  return make_list_method<ThreadPrivate>(system, integrator, dt_s, options);
}

}  // namespace mssim
