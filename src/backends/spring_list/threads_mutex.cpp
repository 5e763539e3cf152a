#include <algorithm>
#include <array>
#include <mutex>
#include <span>

#include "backends/spring_list/list_backends.h"
#include "backends/spring_list/list_method.h"

namespace mssim {
namespace {

/// Springs that a thread computes per critical section. The paper does not state how many springs one lock
/// covers; with one spring per lock nearly all time would be spent on locking (and the paper's speed-up of 3
/// to 4.6 on four cores would be impossible), so a thread computes a block, small enough for its first-level
/// cache.
constexpr std::size_t block_springs = 512;

class MutexPerGroup : public AddingAccumulation {
 public:
  using AddingAccumulation::AddingAccumulation;

  void add(const Team& team, Pair gather) {
    const std::span<const Spring> springs = team.slice_of(list_.springs());
    std::array<Vec3<float>, block_springs> force;
    for (std::size_t done = 0; done < springs.size(); done += block_springs) {
      const auto block = springs.subspan(done, std::min(block_springs, springs.size() - done));
      for (std::size_t i = 0; i < block.size(); ++i) force[i] = list_.force_of(block[i], gather);
      const std::lock_guard lock(accumulation_);
      for (std::size_t i = 0; i < block.size(); ++i) list_.add_force(block[i], force[i]);
    }
  }

 private:
  std::mutex accumulation_;
};

}  // namespace

std::unique_ptr<Backend> make_threads_mutex(const System& system, const Integrator& integrator, double dt_s,
                                            const ExecutionOptions& options) {
  return make_list_method<MutexPerGroup>(system, integrator, dt_s, options);
}

}  // namespace mssim
