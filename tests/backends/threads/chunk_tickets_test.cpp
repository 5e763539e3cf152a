#include "backends/threads/chunk_tickets.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <string>
#include <thread>
#include <vector>

namespace mssim {
namespace {

constexpr std::uint32_t phase_count = 2000, chunk_count = 5;

/// Counts who took what, and who took a chunk of another phase than is open.
class Ledger {
 public:
  void open(std::uint32_t phase) { open_phase_ = phase; }
  void take(const ChunkTickets::Ticket& ticket) {
    if (ticket.phase != open_phase_) ++out_of_turn_;
    ++taken_[ticket.phase * chunk_count + ticket.chunk];
  }
  void expect_phase_whole(std::uint32_t phase) const {
    for (std::uint32_t chunk = 0; chunk < chunk_count; ++chunk)
      EXPECT_EQ(taken_[phase * chunk_count + chunk], 1) << phase << ", " << chunk;
    EXPECT_EQ(out_of_turn_, 0);
  }

 private:
  std::vector<std::atomic<int>> taken_ = std::vector<std::atomic<int>>(phase_count * chunk_count);
  std::atomic<int> out_of_turn_{0};
  std::atomic<std::uint32_t> open_phase_{0};
};

TEST(ChunkTickets, GiveEveryChunkOfEveryPhaseToOneThreadAndFinishAPhaseBeforeTheNext) {
  for (const int helpers : {0, 1, 3}) {
    SCOPED_TRACE(std::to_string(helpers) + " helpers");
    ChunkTickets tickets(chunk_count);
    Ledger ledger;
    const auto act = [&](const ChunkTickets::Ticket& ticket) { ledger.take(ticket); };
    std::vector<std::jthread> group;
    for (int i = 0; i < helpers; ++i)
      group.emplace_back([&] { tickets.work_until_closed(0, 0, act, [] {}); });
    for (std::uint32_t phase = 0; phase < phase_count; ++phase) {
      ledger.open(phase);
      tickets.open();
      tickets.work(0, act);
      tickets.wait_until_finished();
      ledger.expect_phase_whole(phase);
    }
    tickets.close();
  }
}

TEST(ChunkTickets, NeedNoLeader) {
  for (const std::uint32_t threads : {1U, 2U, 3U, 7U}) {  // seven: ranges without a chunk
    SCOPED_TRACE(std::to_string(threads) + " threads");
    ChunkTickets tickets(chunk_count, threads);
    Ledger ledger;
    std::uint32_t phase = 0;
    tickets.open();
    std::vector<std::jthread> group;
    for (std::uint32_t thread = 0; thread < threads; ++thread)
      group.emplace_back([&, thread] {
        tickets.work_until_closed(
            thread, 100, [&](const ChunkTickets::Ticket& ticket) { ledger.take(ticket); },
            [&] {
              ledger.expect_phase_whole(phase);
              if (++phase == phase_count) return tickets.close();
              ledger.open(phase);
              tickets.open();
            });
      });
    group.clear();
    EXPECT_EQ(phase, phase_count);
  }
}

TEST(ChunkTickets, LetPhasesPassWhileAThreadSleepsAndItJoinInThePresentOne) {
  ChunkTickets tickets(4, 2);
  std::vector<std::uint32_t> early;
  for (int phase = 0; phase < 10; ++phase) {
    tickets.open();
    EXPECT_TRUE(tickets.work(0, [&](const ChunkTickets::Ticket& ticket) { early.push_back(ticket.chunk); }));
  }
  EXPECT_EQ(std::vector(early.begin(), early.begin() + 4), (std::vector<std::uint32_t>{0, 1, 3, 2}))
      << "its own from the front, then others' from the back";
  EXPECT_EQ(early.size(), 40U);
  tickets.open();
  std::vector<std::uint32_t> late;
  EXPECT_TRUE(tickets.work(1, [&](const ChunkTickets::Ticket& ticket) {
    EXPECT_EQ(ticket.phase, 10U);
    late.push_back(ticket.chunk);
  }));
  EXPECT_EQ(late, (std::vector<std::uint32_t>{2, 3, 1, 0}));
}

TEST(ChunkTickets, HaveNothingToTakeBeforeAPhaseOpensAndAfterAllIsTaken) {
  ChunkTickets tickets(2);
  int taken = 0;
  const auto act = [&](const ChunkTickets::Ticket&) { ++taken; };
  EXPECT_FALSE(tickets.work(0, act));
  EXPECT_EQ(taken, 0);
  tickets.open();
  EXPECT_TRUE(tickets.work(0, act));
  EXPECT_FALSE(tickets.work(0, act));
  EXPECT_EQ(taken, 2);
  tickets.close();
  EXPECT_FALSE(tickets.work(0, act));
  tickets.work_until_closed(0, 0, act, [] { FAIL() << "nothing was open"; });
  EXPECT_EQ(taken, 2);
}

}  // namespace
}  // namespace mssim
