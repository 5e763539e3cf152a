#pragma once

#include <atomic>
#include <cstdint>
#include <limits>
#include <optional>
#include <thread>
#include <vector>

#include "backends/threads/spin_wait.h"

namespace mssim {

/// Distributes phases of work among threads, chunk by chunk: any awake thread takes the next chunk, so no
/// thread waits for one that sleeps without a chunk, and a thread that wakes up late joins the current phase.
///
/// The chunks are divided into ranges. A thread takes chunks from the front of its own range and, when that
/// is empty, from the back of others, so most of its data is still in its caches from the previous phase.
///
/// With a leader, which waits for something else (a device) between phases: the leader calls open(), work()
/// and wait_until_finished() for each phase, and finally close(); its helpers call work_until_closed().
/// Without one: open(), then all threads call work_until_closed(); the last opens the next phase or closes.
class ChunkTickets {
 public:
  struct Ticket {
    std::uint32_t phase;  ///< from 0, one more after every open()
    std::uint32_t chunk;
  };
  static constexpr std::uint32_t most_phases = (1U << 24) - 1;
  static constexpr std::uint32_t most_chunks = (1U << 20) - 1;

  /// Every phase has the chunks 0 to chunks - 1; range s of n begins at chunk chunks s / n. There may be
  /// most_chunks chunks, and open() may be called most_phases times.
  explicit ChunkTickets(std::uint32_t chunks, std::uint32_t ranges = 1) : chunks_(chunks), ranges_(ranges) {}

  /// Begins the next phase. Earlier writes are visible to takers of tickets.
  void open() {
    finished_.store(0, std::memory_order_relaxed);
    change_and_notify(opened_, opened_.load(std::memory_order_relaxed) + 1);
  }
  /// Ends all work.
  void close() { change_and_notify(opened_, closed); }

  /// Calls act(ticket) for every chunk that it can get, those of `range` first; returns whether that finished
  /// the phase.
  template <class Act>
  bool work(std::uint32_t range, Act&& act) {
    const std::uint32_t opened = opened_.load(std::memory_order_acquire);
    if (opened == closed) return false;
    for (std::uint32_t i = 0; i < ranges_.size(); ++i) {
      std::uint32_t done = 0;
      for (; const auto ticket = take(range, i == 0, opened); ++done) act(*ticket);
      // Before scanning other ranges: the last thread need not scan.
      if (done > 0 && finished_.fetch_add(done, std::memory_order_acq_rel) + done == chunks_) return true;
      if (++range == ranges_.size()) range = 0;
    }
    return false;
  }
  /// Works in every phase until close(). Calls finished() whenever it has finished a phase. Between phases it
  /// spins `spins` times before it yields its core.
  template <class Act, class Finished>
  void work_until_closed(std::uint32_t range, int spins, Act&& act, Finished&& finished) {
    for (std::uint32_t opened = opened_.load(std::memory_order_acquire); opened != closed;) {
      if (work(range, act)) {
        finished();
        opened = opened_.load(std::memory_order_acquire);
      } else {
        opened = wait_for_change(opened_, opened, spins);
      }
    }
  }
  /// Waits until all chunks of the phase are done. They are being processed, so this is short, unless a
  /// thread was interrupted: it may need this thread's core.
  void wait_until_finished() const {
    while (finished_.load(std::memory_order_acquire) != chunks_) std::this_thread::yield();
  }

 private:
  static constexpr std::uint32_t closed = std::numeric_limits<std::uint32_t>::max();

  /// The remaining chunks of a range.
  struct Left {
    std::uint32_t opened;  // their phase: number of phases opened with it
    std::uint32_t begin, end;
  };
  struct alignas(64) Range {             // a cache line
    std::atomic<std::uint64_t> left{0};  // a Left
  };

  static std::uint64_t pack(const Left& left) {
    return (std::uint64_t{left.opened} << 40) | (std::uint64_t{left.begin} << 20) | left.end;
  }
  static Left unpack(std::uint64_t bits) {
    return {static_cast<std::uint32_t>(bits >> 40), static_cast<std::uint32_t>(bits >> 20) & most_chunks,
            static_cast<std::uint32_t>(bits) & most_chunks};
  }
  Left whole(std::uint32_t range, std::uint32_t opened) const {
    const auto bound = [&](std::uint64_t s) {
      return static_cast<std::uint32_t>(chunks_ * s / ranges_.size());
    };
    return {opened, bound(range), bound(range + 1)};
  }
  /// An untaken chunk of a range, or nothing. A range of an older phase than the current one is full again:
  /// it was empty, otherwise that phase would not have ended.
  std::optional<Ticket> take(std::uint32_t range, bool own, std::uint32_t opened) {
    std::atomic<std::uint64_t>& stored = ranges_[range].left;
    std::uint64_t bits = stored.load(std::memory_order_acquire);
    while (true) {
      Left left = unpack(bits);
      if (left.opened < opened) left = whole(range, opened);
      if (left.begin == left.end) return std::nullopt;
      const std::uint32_t chunk = own ? left.begin++ : --left.end;
      if (stored.compare_exchange_weak(bits, pack(left), std::memory_order_acq_rel,
                                       std::memory_order_acquire))
        return Ticket{left.opened - 1, chunk};
    }
  }

  const std::uint32_t chunks_;
  std::vector<Range> ranges_;
  alignas(64) std::atomic<std::uint32_t> opened_{0};    // phases, or closed
  alignas(64) std::atomic<std::uint32_t> finished_{0};  // chunks of the phase
};

}  // namespace mssim
