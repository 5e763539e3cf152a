#pragma once

#include <atomic>
#include <cstddef>

#include "backends/threads/spin_wait.h"

namespace mssim {

/// A barrier for threads that meet every few microseconds (spin_wait.h says how it waits).
class SpinBarrier {
 public:
  explicit SpinBarrier(std::size_t threads) : threads_(threads) {}

  /// Returns when all threads have called it as often as this one. What they wrote before is visible after.
  void wait() {
    const unsigned phase = phase_.load(std::memory_order_acquire);
    if (arrived_.fetch_add(1, std::memory_order_acq_rel) + 1 == threads_) {
      arrived_.store(0, std::memory_order_relaxed);
      change_and_notify(phase_, phase + 1);
      return;
    }
    wait_for_change(phase_, phase, spins);
  }

 private:
  /// Some microseconds: about as long as the parts of a balanced step differ.
  static constexpr int spins = 300;

  const std::size_t threads_;
  std::atomic<std::size_t> arrived_{0};
  std::atomic<unsigned> phase_{0};
};

}  // namespace mssim
