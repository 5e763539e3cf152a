#include <algorithm>
#include <array>
#include <barrier>
#include <mutex>
#include <optional>
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

/// Its threads sleep between calls and end in rest().
class ThreadsMutex final : public Backend {
 public:
  ThreadsMutex(const System& system, const Integrator& integrator, double dt_s, int threads)
      : list_(system, integrator, dt_s),
        integrator_(integrator),
        threads_(static_cast<std::size_t>(threads)),
        together_(threads) {}
  ~ThreadsMutex() override { end_threads(); }

  /// Also makes the threads, so a caller who times step() does not time that.
  void set_state(const State& state) override {
    list_.set_state(state);
    if (group_.size() + 1 < threads_) make_threads();
  }
  State state() const override { return list_.state(); }
  int threads() const override { return static_cast<int>(threads_); }
  void rest() override { end_threads(); }

  void step(int count) override {
    if (count == 0) return;  // without a step nothing keeps a thread from the next call's count
    if (group_.size() + 1 < threads_) make_threads();
    count_ = count;
    together_.arrive_and_wait();
    run(0, count);
  }

 private:
  void make_threads() {
    std::promise<bool> complete;  // whether all threads exist: those that do would wait for the missing ones
    const std::shared_future<bool> all_are_there = complete.get_future();
    try {
      group_.reserve(threads_ - 1);
      const OnAllProcessCpus inherited;
      for (std::size_t thread = 1; thread < threads_; ++thread)
        group_.emplace_back([this, thread, all_are_there] {
          if (all_are_there.get()) serve(thread);
        });
    } catch (const std::system_error& error) {
      complete.set_value(false);
      const std::size_t made = group_.size() + 1;
      group_.clear();
      throw BackendFailure(fmt::format("the system has created {} of {} threads ({}): request fewer with "
                                       "--threads, or end other programs",
                                       made, threads_, error.code().message()),
                           "");
    }
    complete.set_value(true);
  }

  void end_threads() {
    if (group_.empty()) return;
    count_.reset();
    together_.arrive_and_wait();
    group_.clear();
  }

  /// What a thread but the first does: the steps of each call, until there are no more.
  void serve(std::size_t thread) {
    for (;;) {
      together_.arrive_and_wait();
      if (!count_) return;
      run(thread, *count_);
    }
  }

  void run(std::size_t thread, int count) {
    const auto bound = [&](std::size_t all, std::size_t part) { return all * part / threads_; };
    const std::size_t first_node = bound(list_.nodes(), thread), last_node = bound(list_.nodes(), thread + 1);
    const auto springs = list_.springs().subspan(
        bound(list_.springs().size(), thread),
        bound(list_.springs().size(), thread + 1) - bound(list_.springs().size(), thread));
    with_integrator(integrator_, [&](auto method) {
      for (int step = 0; step < count; ++step) {
        for_each_stage<method>([&](auto stage) {
          list_.clear_forces(first_node, last_node);
          together_.arrive_and_wait();
          add_forces(springs, integrators[method].stages[stage].gather);
          together_.arrive_and_wait();
          list_.template update_nodes<method, stage>(first_node, last_node);
        });
        together_.arrive_and_wait();
        if (thread == 0) list_.end_step();
        together_.arrive_and_wait();
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
  std::barrier<> together_;
  std::optional<int> count_;  ///< steps that a call asks for; none: the threads end
  std::vector<std::jthread> group_;
  std::mutex accumulation_;
};

}  // namespace

std::unique_ptr<Backend> make_threads_mutex(const System& system, const Integrator& integrator, double dt_s,
                                            const ExecutionOptions& options) {
  return std::make_unique<ThreadsMutex>(system, integrator, dt_s, options.threads);
}

}  // namespace mssim
