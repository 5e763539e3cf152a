#include "backends/chunk_tickets.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

namespace mssim {
namespace {

TEST(ChunkTickets, GiveEveryChunkOfEveryPhaseToOneThreadAndFinishAPhaseBeforeTheNext) {
  constexpr std::uint32_t phases = 2000, chunks = 5;
  for (const int helpers : {0, 1, 3}) {
    ChunkTickets tickets(chunks);
    std::vector<std::atomic<int>> taken(phases * chunks);
    std::atomic<int> out_of_turn{0};
    std::atomic<std::uint32_t> open_phase{0};
    const auto work = [&] {
      while (const auto ticket = tickets.take()) {
        if (ticket->phase != open_phase) ++out_of_turn;
        ++taken[ticket->phase * chunks + ticket->chunk];
        tickets.finish_one();
      }
    };
    std::vector<std::jthread> group;
    for (int i = 0; i < helpers; ++i)
      group.emplace_back([&] {
        while (tickets.wait_for_work()) work();
      });
    for (std::uint32_t phase = 0; phase < phases; ++phase) {
      open_phase = phase;
      tickets.open();
      work();
      tickets.wait_until_finished();
      for (std::uint32_t chunk = 0; chunk < chunks; ++chunk)
        ASSERT_EQ(taken[phase * chunks + chunk], 1) << phase << ", " << chunk;
    }
    tickets.close();
    group.clear();
    EXPECT_EQ(out_of_turn, 0) << helpers << " helpers";
  }
}

TEST(ChunkTickets, HaveNothingToTakeBeforeAPhaseOpensAndAfterAllIsTaken) {
  ChunkTickets tickets(2);
  EXPECT_FALSE(tickets.take());
  tickets.open();
  EXPECT_TRUE(tickets.take());
  EXPECT_TRUE(tickets.take());
  EXPECT_FALSE(tickets.take());
  tickets.close();
  EXPECT_FALSE(tickets.take());
  EXPECT_FALSE(tickets.wait_for_work());
}

}  // namespace
}  // namespace mssim
