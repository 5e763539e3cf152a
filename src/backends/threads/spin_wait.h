#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <thread>

#include "backends/threads/team_gain.h"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace mssim {

/// Between two reads of a value that another thread writes: leaves the core's resources to its other thread.
inline void pause_spinning() {
#if defined(__x86_64__)
  _mm_pause();
#elif defined(__aarch64__)
  asm volatile("yield");
#endif
}

/// Spins `spins` times, or until an atomic's value differs from `old`. Returns its value.
template <class T>
T spin_for_change(const std::atomic<T>& value, T old, int spins) {
  T now = value.load(std::memory_order_acquire);
  for (int tries = 0; tries < spins && now == old; ++tries) {
    pause_spinning();
    now = value.load(std::memory_order_acquire);
  }
  return now;
}

/// Waits until an atomic's value differs from `old` and returns it, for threads that synchronise every few
/// microseconds: spins `spins` times, then yields its core `yields` times, then sleeps until notified.
///
/// OpenMP's own barrier spins for milliseconds by default, which is right on an idle machine. If another
/// process uses one core, however, the waiting thread occupies the other one, on which the thread it waits
/// for could run: a step of a 2,500-node cloth then took milliseconds instead of 6 microseconds.
template <class T>
T wait_for_change(const std::atomic<T>& value, T old, int spins, int yields = 100) {
  if (const T now = spin_for_change(value, old, spins); now != old) return now;
  // If both threads share a core, the other one runs at the first yield.
  for (int tries = 0; tries < yields; ++tries) {
    std::this_thread::yield();
    if (const T now = value.load(std::memory_order_acquire); now != old) return now;
  }
  value.wait(old, std::memory_order_seq_cst);
  return value.load(std::memory_order_acquire);
}

/// Stores a value and wakes the threads that wait for a change. This thread's earlier writes are visible to
/// them. Sequentially consistent, because libstdc++ 12 wakes no thread if it sees no sleeper: with a mere
/// release, a CPU may look for sleepers before others see the value, and a thread that is about to sleep
/// would never be woken.
template <class T>
void change_and_notify(std::atomic<T>& value, T now) {
  value.store(now, std::memory_order_seq_cst);
  value.notify_all();
}

/// Progress of a thread whose work others build on: they wait for no more work and no more threads than they
/// need, while a barrier waits for all threads and all of their work. One thread writes it at a time.
class ThreadProgress {
 public:
  /// Publishes progress `number`, which must not decrease. Earlier writes are visible to threads that waited
  /// for it.
  void reach(std::uint64_t number) { reached_.store(number, std::memory_order_release); }

  bool has_reached(std::uint64_t number) const { return reached_.load(std::memory_order_acquire) >= number; }

  /// Returns when `number` is reached. Adds the time to `waited` if it was so long that other programs may be
  /// the cause (TeamGain): reading the clock takes as long as a short wait.
  void wait_for(std::uint64_t number, TeamGain::Duration& waited) const {
    if (spins_until(number, first_spins)) return;
    const TeamGain::Clock::time_point begin = TeamGain::Clock::now();
    if (!spins_until(number, spins)) yield_until(number);
    waited += TeamGain::Clock::now() - begin;
  }

 private:
  static constexpr int first_spins = 10, spins = 290;  // together as many as in SpinBarrier

  bool spins_until(std::uint64_t number, int most) const {
    for (int tries = 0; tries < most; ++tries) {
      if (has_reached(number)) return true;
      pause_spinning();
    }
    return false;
  }

  /// There is no notification, so that reach() costs nothing: long waits poll from time to time.
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
