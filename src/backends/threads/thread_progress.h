#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <thread>

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

  bool has_reached(std::uint64_t number) const { return reached_.load(std::memory_order_acquire) >= number; }

  /// Returns when `number` is reached. Adds the time to `waited` if that was so long that other programs may
  /// be the reason (TeamGain): to read the clock takes as long as a short wait.
  void wait_for(std::uint64_t number, TeamGain::Duration& waited) const {
    if (spins_until(number, first_spins)) return;
    const TeamGain::Clock::time_point begin = TeamGain::Clock::now();
    if (!spins_until(number, spins)) yield_until(number);
    waited += TeamGain::Clock::now() - begin;
  }

 private:
  static constexpr int first_spins = 10, spins = 290;  // together as many as SpinBarrier has

  bool spins_until(std::uint64_t number, int most) const {
    for (int tries = 0; tries < most; ++tries) {
      if (has_reached(number)) return true;
      pause_spinning();
    }
    return false;
  }

  /// Nobody is notified, so that reach() costs nothing: who has waited long asks again from time to time.
  void yield_until(std::uint64_t number) const {
    constexpr int yields = 100;
    for (int tries = 0; !has_reached(number); ++tries)
      if (tries < yields)
        std::this_thread::yield();
      else
        std::this_thread::sleep_for(std::chrono::microseconds(50));
  }

  alignas(64) std::atomic<std::uint64_t> reached_{0};  // a cache line
};

}  // namespace mssim
