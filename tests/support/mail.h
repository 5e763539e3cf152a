#pragma once

#include <condition_variable>
#include <deque>
#include <mutex>

#include "tests/support/testing.h"

namespace mssim {

/// Floats on their way from one thread to another one: what a message of MPI is between processes.
class Mail {
 public:
  void send(const float* floats, std::size_t count) {
    const std::scoped_lock lock(mutex_);
    letters_.emplace_back(floats, floats + count);
    changed_.notify_one();
  }
  /// Waits for the next letter.
  void receive(float* floats) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return !letters_.empty(); });
    std::ranges::copy(letters_.front(), floats);
    letters_.pop_front();
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::vector<float>> letters_;
};

}  // namespace mssim
