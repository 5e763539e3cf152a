#include <algorithm>
#include <array>
#include <barrier>
#include <future>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

#include "backends/spring_list/list_backends.h"
#include "backends/spring_list/spring_list.h"
#include "platform/machine.h"

namespace mssim {
namespace {

/// Springs that a thread computes per critical section. The paper does not state how many springs one lock
/// covers; with one spring per lock nearly all time would be spent on locking (and the paper's speed-up of 3
/// to 4.6 on four cores would be impossible), so a thread computes a block, small enough for its first-level
/// cache.
constexpr std::size_t block_springs = 512;

class ThreadsMutex final : public Backend {
 public:
  ThreadsMutex(const System& system, const Integrator& integrator, double dt_s, int threads)
      : list_(system, integrator, dt_s),
        integrator_(integrator),
        threads_(static_cast<std::size_t>(threads)) {}

  void set_state(const State& state) override { list_.set_state(state); }
  State state() const override { return list_.state(); }
  int threads() const override { return static_cast<int>(threads_); }

  void step(int count) override {
    std::barrier together(static_cast<std::ptrdiff_t>(threads_));
    std::promise<bool> complete;  // whether all threads exist: those that do would wait for the missing ones
    const std::shared_future<bool> all_are_there = complete.get_future();
    std::vector<std::jthread> group;
    try {
      const OnAllProcessCpus inherited;
      for (std::size_t thread = 1; thread < threads_; ++thread)
        group.emplace_back([&, thread] {
          if (all_are_there.get()) run(thread, count, together);
        });
    } catch (const std::system_error& error) {
      complete.set_value(false);
      throw BackendFailure(fmt::format("the system has created {} of {} threads ({}): request fewer with "
                                       "--threads, or end other programs",
                                       group.size() + 1, threads_, error.code().message()),
                           "");
    }
    complete.set_value(true);
    run(0, count, together);
  }

 private:
  void run(std::size_t thread, int count, std::barrier<>& together) {
    const auto bound = [&](std::size_t all, std::size_t part) { return all * part / threads_; };
    const std::size_t first_node = bound(list_.nodes(), thread), last_node = bound(list_.nodes(), thread + 1);
    const auto springs = list_.springs().subspan(
        bound(list_.springs().size(), thread),
        bound(list_.springs().size(), thread + 1) - bound(list_.springs().size(), thread));
    with_integrator(integrator_, [&](auto method) {
      for (int step = 0; step < count; ++step) {
        for_each_stage<method>([&](auto stage) {
          list_.clear_forces(first_node, last_node);
          together.arrive_and_wait();
          add_forces(springs, integrators[method].stages[stage].gather);
          together.arrive_and_wait();
          list_.template update_nodes<method, stage>(first_node, last_node);
        });
        together.arrive_and_wait();
        if (thread == 0) list_.end_step();
        together.arrive_and_wait();
      }
    });
  }

  void add_forces(std::span<const Spring> springs, Pair gather) {
    std::array<Vec3<float>, block_springs> force;
    for (std::size_t done = 0; done < springs.size(); done += block_springs) {
      const auto block = springs.subspan(done, std::min(block_springs, springs.size() - done));
      for (std::size_t i = 0; i < block.size(); ++i) force[i] = list_.force_of(block[i], gather);
      const std::lock_guard lock(accumulation_);
      for (std::size_t i = 0; i < block.size(); ++i) list_.add_force(block[i], force[i]);
    }
  }

  SpringList<float> list_;
  const Integrator& integrator_;
  const std::size_t threads_;
  std::mutex accumulation_;
};

}  // namespace

std::unique_ptr<Backend> make_threads_mutex(const System& system, const Integrator& integrator, double dt_s,
                                            const ExecutionOptions& options) {
  return std::make_unique<ThreadsMutex>(system, integrator, dt_s, options.threads);
}

}  // namespace mssim
