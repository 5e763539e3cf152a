#pragma once

#include <atomic>
#include <cstdint>
#include <limits>
#include <optional>
#include <thread>
#include <vector>

#include "backends/threads/spin_wait.h"

namespace mssim {

/// Shares phases of work among threads, chunk by chunk: whoever is awake takes the next one, so that nobody
/// waits for a thread that sleeps without one, and a thread that wakes up late joins in the present phase.
///
/// The chunks are cut into ranges. A thread takes from the front of its own range and, when that is empty,
/// from the back of others, so that most of its work is what its caches hold from the phase before.
///
/// With a leader, who waits for something else (a device) between any two phases: the leader calls open(),
/// work() and wait_until_finished() for each, at last close(); its helpers call work_until_closed(). Without
/// one: open(), then all threads call work_until_closed(), and whoever ends a phase opens the next or closes.
class ChunkTickets {
 public:
  struct Ticket {
    std::uint32_t phase;  ///< from 0, the next one at every open()
    std::uint32_t chunk;
  };
  static constexpr std::uint32_t most_phases = (1U << 24) - 1;
  static constexpr std::uint32_t most_chunks = (1U << 20) - 1;

  /// Every phase has the chunks 0 to chunks - 1, range s of n those from chunks s / n on. There may be
  /// most_chunks, and open() may be called most_phases times.
  explicit ChunkTickets(std::uint32_t chunks, std::uint32_t ranges = 1) : chunks_(chunks), ranges_(ranges) {}

  /// Begins the next phase. What was written before is visible to who takes a ticket.
  void open() {
    finished_.store(0, std::memory_order_relaxed);
    change_and_notify(opened_, opened_.load(std::memory_order_relaxed) + 1);
  }
  /// Ends it all.
  void close() { change_and_notify(opened_, closed); }

  /// Calls act(ticket) for every chunk that it can get, those of `range` first; whether the phase is finished
  /// with them.
  template <class Act>
  bool work(std::uint32_t range, Act&& act) {
    const std::uint32_t opened = opened_.load(std::memory_order_acquire);
    if (opened == closed) return false;
    for (std::uint32_t i = 0; i < ranges_.size(); ++i) {
      std::uint32_t done = 0;
      for (; const auto ticket = take(range, i == 0, opened); ++done) act(*ticket);
      // Said before others' ranges are looked at: who is the last need not look.
      if (done > 0 && finished_.fetch_add(done, std::memory_order_acq_rel) + done == chunks_) return true;
      if (++range == ranges_.size()) range = 0;
    }
    return false;
  }
  /// Works in every phase until all is over. Calls finished() whenever it has finished one. Between phases
  /// it spins `spins` times before it offers its core.
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
  /// Waits until all chunks of the phase are done. Their work is under way, so this is short, unless a thread
  /// was interrupted: then its core may be this one.
  void wait_until_finished() const {
    while (finished_.load(std::memory_order_acquire) != chunks_) std::this_thread::yield();
  }

 private:
  static constexpr std::uint32_t closed = std::numeric_limits<std::uint32_t>::max();

  /// The chunks of a range that nobody has taken.
  struct Left {
    std::uint32_t opened;  // of which phase: how many had been opened with it
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
  /// A chunk of a range that nobody else has, or nothing. A range still left from an older phase than the one
  /// opened is whole again: all of it was taken, else that phase would not have ended.
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
