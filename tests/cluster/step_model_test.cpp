#include "cluster/step_model.h"

#include <gtest/gtest.h>

namespace mssim {
namespace {

constexpr ClusterRates slow_network{
    .node_stage_s = 1e-9, .latency_s = 1e-3, .bytes_per_second = 1e9, .processor_copies = false};

TEST(StepModel, OfOneProcessIsWhatItComputes) {
  const std::optional<ExchangeWork> work = work_of({100, 200, 4}, {});
  ASSERT_TRUE(work);
  EXPECT_EQ(work->node_stages, 4 * 100 * 200);
  EXPECT_EQ(work->bytes, 0);
  EXPECT_EQ(work->rounds_of_messages, 0);
  EXPECT_DOUBLE_EQ(exchange_seconds(*work, slow_network), 4 * 100 * 200 * 1e-9);
}

TEST(StepModel, CountsColumnsThatTwoProcessesComputeAndBytesThatTheySend) {
  // Two steps of two stages: eight ghosts on each side, of which the four stages compute 6, 4, 2 and 0.
  const std::optional<ExchangeWork> work = work_of({100, 400, 2}, {1, 4, 2});
  ASSERT_TRUE(work);
  EXPECT_EQ(ghost_nodes({100, 400, 2}, {1, 4, 2}), 8);
  EXPECT_EQ(work->node_stages, 100 * (4 * 100 + 2 * (6 + 4 + 2 + 0)));
  EXPECT_EQ(work->inner_node_stages, 4 * 100 * (100 - 2 * 8));
  EXPECT_EQ(work->bytes, 2 * 8 * 100 * 24);
  EXPECT_EQ(work->rounds_of_messages, 1);
  // The two of two processes have one neighbour each.
  EXPECT_EQ(work_of({100, 400, 2}, {1, 2, 2})->bytes, 8 * 100 * 24);
}

TEST(StepModel, OfBlocksSendsCornersOnTheWay) {
  const std::optional<ExchangeWork> work = work_of({300, 300, 1}, {3, 3, 1});
  ASSERT_TRUE(work);
  EXPECT_EQ(work->node_stages, 100 * 100);
  EXPECT_EQ(work->inner_node_stages, 96 * 96);
  EXPECT_EQ(work->bytes, 24 * 2 * (2 * 100 + 2 * 104));
  EXPECT_EQ(work->rounds_of_messages, 2);
}

TEST(StepModel, HidesWhatTheNetworkDoesBehindInnerNodesAndNotWhatTheProcessorCopies) {
  const ExchangeWork work{
      .node_stages = 1e6, .inner_node_stages = 9e5, .bytes = 2e5, .rounds_of_messages = 1};
  ClusterRates rates = slow_network;  // 1 ms to compute, 0.9 of it inner, 1 ms latency, 0.2 ms volume
  EXPECT_DOUBLE_EQ(exchange_seconds(work, rates), 1e-3 + 0.3e-3);
  rates.processor_copies = true;
  EXPECT_DOUBLE_EQ(exchange_seconds(work, rates), 1e-3 + 1e-3 + 0.2e-3);
  rates.latency_s = 1e-6;
  EXPECT_DOUBLE_EQ(exchange_seconds(work, rates), 1e-3 + 1e-6 + 0.2e-3);
  rates.processor_copies = false;
  EXPECT_DOUBLE_EQ(exchange_seconds(work, rates), 1e-3);
}

TEST(StepModel, RefusesPartsThatAreSmallerThanTheirGhosts) {
  EXPECT_TRUE(work_of({100, 16, 4}, {1, 2, 1}));
  EXPECT_FALSE(work_of({100, 15, 4}, {1, 2, 1}));
  EXPECT_FALSE(work_of({15, 100, 4}, {2, 1, 1}));
  EXPECT_FALSE(best_columns({1e4, 1e4, 4}, 10'000, slow_network));
  EXPECT_TRUE(best_blocks({1e4, 1e4, 4}, 10'000, slow_network));
}

TEST(StepModel, TakesSeveralStepsAnExchangeWhereMessagesAreSlow) {
  const ClothStep small{1000, 4000, 1}, large{20'000, 80'000, 1};
  const std::optional<CutTime> slow = best_columns(small, 100, slow_network);
  ASSERT_TRUE(slow);
  EXPECT_EQ(slow->cut.steps_an_exchange, 4);
  EXPECT_EQ(slow->cut.across, 100);
  // A step of a large one takes longer than a message.
  EXPECT_EQ(best_columns(large, 100, slow_network)->cut.steps_an_exchange, 1);
  EXPECT_EQ(best_columns(small, 100, slow_network, 1)->cut.steps_an_exchange, 1);
  // rk4 has all four stages in one step.
  EXPECT_EQ(best_columns({1000, 4000, 4}, 100, slow_network)->cut.steps_an_exchange, 1);
}

TEST(StepModel, CutsRowsTooWhereColumnsBecomeNarrow) {
  ClusterRates fast = slow_network;
  fast.latency_s = 1e-6;
  fast.bytes_per_second = 1e9;
  const ClothStep cloth{1e4, 1e4, 1};
  const auto faster_in_blocks = [&](int processes) {
    return best_blocks(cloth, processes, fast)->step_s < best_columns(cloth, processes, fast)->step_s;
  };
  EXPECT_FALSE(faster_in_blocks(4));
  EXPECT_TRUE(faster_in_blocks(2000));
  EXPECT_EQ(best_blocks(cloth, 7, fast), std::nullopt);
}

}  // namespace
}  // namespace mssim
