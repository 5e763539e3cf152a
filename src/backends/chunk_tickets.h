#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <thread>

namespace mssim {

/// Shares phases of work among threads, chunk by chunk, for a leader that must wait for something else (a
/// device) between any two phases and for helpers that sleep meanwhile. Whoever is awake takes the next
/// chunk, so that the leader never waits for a helper to wake up: in a phase that is over before one does,
/// the leader has done all of it.
///
/// The leader: open(), then take() and finish_one() until there is nothing to take, then
/// wait_until_finished(); at last close(). Helpers: while wait_for_work(), the same two.
class ChunkTickets {
 public:
  struct Ticket {
    std::uint32_t phase;  ///< from 0, the next one at every open()
    std::uint32_t chunk;
  };

  /// Every phase has the chunks 0 to chunks - 1.
  explicit ChunkTickets(std::uint32_t chunks) : chunks_(chunks), next_(pack({closed_phase - 1, chunks})) {}

  /// Begins the next phase. What the leader wrote before is visible to who takes a ticket.
  void open() {
    const std::uint32_t phase = unpack(next_.load(std::memory_order_relaxed)).phase + 1;
    finished_.store(0, std::memory_order_relaxed);
    publish({phase == closed_phase ? 0 : phase, 0});
  }
  /// Ends it all.
  void close() { publish({closed_phase, chunks_}); }

  /// A chunk that nobody else has, or nothing.
  std::optional<Ticket> take() {
    std::uint64_t next = next_.load(std::memory_order_acquire);
    while (unpack(next).chunk < chunks_)
      if (next_.compare_exchange_weak(next, next + 1, std::memory_order_acq_rel, std::memory_order_acquire))
        return unpack(next);
    return std::nullopt;
  }
  /// The work of a ticket is done.
  void finish_one() { finished_.fetch_add(1, std::memory_order_acq_rel); }

  /// Waits until the work of all the phase's tickets is done. It is under way, so this is short, unless a
  /// thread was interrupted: then its core may be this one.
  void wait_until_finished() const {
    while (finished_.load(std::memory_order_acquire) != chunks_) std::this_thread::yield();
  }
  /// Waits until there may be something to take; false once it is all over.
  bool wait_for_work() const {
    std::uint64_t next = next_.load(std::memory_order_acquire);
    // A device on the same cores runs in place of a thread that yields.
    for (int tries = 0; tries < yields && unpack(next).chunk >= chunks_ && !is_closed(next); ++tries) {
      std::this_thread::yield();
      next = next_.load(std::memory_order_acquire);
    }
    while (unpack(next).chunk >= chunks_ && !is_closed(next)) {
      next_.wait(next, std::memory_order_acquire);
      next = next_.load(std::memory_order_acquire);
    }
    return !is_closed(next);
  }

 private:
  static constexpr std::uint32_t closed_phase = 0xffffffff;
  static constexpr int yields = 100;

  static std::uint64_t pack(const Ticket& ticket) {
    return (std::uint64_t{ticket.phase} << 32) | ticket.chunk;
  }
  static Ticket unpack(std::uint64_t bits) {
    return {static_cast<std::uint32_t>(bits >> 32), static_cast<std::uint32_t>(bits)};
  }
  static bool is_closed(std::uint64_t bits) { return unpack(bits).phase == closed_phase; }
  void publish(const Ticket& ticket) {
    next_.store(pack(ticket), std::memory_order_release);
    next_.notify_all();
  }

  const std::uint32_t chunks_;
  std::atomic<std::uint64_t> next_;         // a Ticket
  std::atomic<std::uint32_t> finished_{0};  // chunks of the phase
};

}  // namespace mssim
