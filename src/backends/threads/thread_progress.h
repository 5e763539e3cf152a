#pragma once

#include <atomic>
#include <cstdint>

#include "backends/threads/spin_wait.h"
#include "backends/threads/team_gain.h"

namespace mssim {

/// How far somebody has come in work that others build on: they wait for no more than they need, of no more
/// threads than they need, where a barrier is for all threads and all of their work. One thread writes it at
/// a time.
class ThreadProgress {
 public:
  /// What was written before is visible to who has waited for `number`, which is not less than before.
  void reach(std::uint64_t number) { reached_.store(number, std::memory_order_release); }

  /// Returns when `number` is reached. Adds the time to `waited` if that was so long that other programs may
  /// be the reason (TeamGain): to read the clock takes as long as a short wait.
  void wait_for(std::uint64_t number, TeamGain::Duration& waited) const {
    for (int tries = 0; tries < first_spins; ++tries) {
      if (reached_.load(std::memory_order_acquire) >= number) return;
      pause_spinning();
    }
    const TeamGain::Clock::time_point begin = TeamGain::Clock::now();
    for (int tries = 0; tries < spins; ++tries) {
      if (reached_.load(std::memory_order_acquire) >= number) break;
      pause_spinning();
    }
    wait_until_at_least(reached_, number);
    waited += TeamGain::Clock::now() - begin;
  }

 private:
  static constexpr int first_spins = 10, spins = 290;  // together as many as SpinBarrier has

  alignas(64) std::atomic<std::uint64_t> reached_{0};  // a cache line
};

}  // namespace mssim
