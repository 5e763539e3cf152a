#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "backends/accumulation/list_method.h"
#include "backends/accumulation/methods.h"

namespace mssim {
namespace {

class Gather {
 public:
  Gather(const System& system, SpringList<float>& list, std::size_t /*threads*/)
      : list_(list), begin_(system.nodes() + 1, 0), springs_(2 * system.springs.size()) {
    for (const Spring& spring : system.springs) {
      ++begin_[spring.first + 1];
      ++begin_[spring.second + 1];
    }
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    std::vector<std::size_t> next(begin_);
    for (Spring spring : system.springs) {
      springs_[next[spring.first]++] = spring;
      std::swap(spring.first, spring.second);
      springs_[next[spring.first]++] = spring;
    }
  }

  void prepare(const Team& /*team*/) {}

  void add(const Team& team, Pair gather) {
    for (std::size_t node = team.begin(list_.nodes()); node < team.end(list_.nodes()); ++node) {
      Vec3<float> sum;
      for (std::size_t spring = begin_[node]; spring < begin_[node + 1]; ++spring)
        sum += list_.force_of(springs_[spring], gather);
      list_.force(node) = sum;
    }
  }

  void finish(const Team& /*team*/) {}

 private:
  SpringList<float>& list_;
  std::vector<std::size_t> begin_;  // [nodes + 1] where a node's springs begin
  std::vector<Spring> springs_;     // node by node, each spring twice, the node itself the first end
};

}  // namespace

std::unique_ptr<Backend> make_gather(const System& system, const Integrator& integrator, double dt_s,
                                     const ExecutionOptions& options) {
  return make_list_method<Gather>(system, integrator, dt_s, options);
}

}  // namespace mssim
