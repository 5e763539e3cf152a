#pragma once

#include <cstddef>
#include <span>

#include "backends/threads/spin_barrier.h"

namespace mssim {

/// The threads that take a step together, as one of them sees them.
struct Team {
  std::size_t thread;
  std::size_t threads;
  SpinBarrier& barrier;

  /// Where this thread's slice of `count` things begins; the next thread's begins where it ends.
  std::size_t begin(std::size_t count) const { return count * thread / threads; }
  std::size_t end(std::size_t count) const { return count * (thread + 1) / threads; }
  template <class T>
  std::span<const T> slice_of(std::span<const T> all) const {
    return all.subspan(begin(all.size()), end(all.size()) - begin(all.size()));
  }
};

}  // namespace mssim
