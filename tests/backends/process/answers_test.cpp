#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "backends/interface/backend.h"
#include "backends/process/conversation.h"

namespace mssim {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// What taking this answer to `costs` fails with.
std::string complaint_about_cost(const std::string& line) {
  Communication costs;
  try {
    take_cost(costs, line);
  } catch (const AnswerFailure& failure) {
    return failure.what();
  }
  return "accepted";
}

TEST(Answers, SayWhatAProgramIs) {
  Introduction introduction;
  for (const char* line : {"device a chip", "threads 3", "precision single", "note first", "note second",
                           "untimed too crowded", "tells costs"})
    EXPECT_FALSE(take_introduction(introduction, line)) << line;
  EXPECT_TRUE(take_introduction(introduction, "ready 1"));
  EXPECT_EQ(introduction.device, "a chip");
  EXPECT_EQ(introduction.threads, 3);
  EXPECT_EQ(introduction.note, "single precision; first; second");
  EXPECT_EQ(introduction.untimed, "too crowded");
  EXPECT_TRUE(introduction.tells_costs);
}

TEST(Answers, RefuseAProgramOrItsScene) {
  Introduction introduction;
  EXPECT_THROW(take_introduction(introduction, "unsupported red springs"), Unsupported);
  EXPECT_THROW(take_introduction(introduction, "unavailable no chip"), Unavailable);
  EXPECT_THROW(take_introduction(introduction, "failed no licence"), AnswerFailure);
  for (const char* line : {"", "ready 2", "threads 0", "threads 5000", "tells", "tells jokes", "device"})
    EXPECT_THROW(take_introduction(introduction, line), AnswerFailure) << line;
}

TEST(Answers, SayWhatProcessesSpendOnEachOther) {
  Communication costs;
  for (const char* line : {"cost waiting 0.125", "cost packing 0.5", "cost bytes 4800", "cost messages 2"})
    EXPECT_FALSE(take_cost(costs, line)) << line;
  EXPECT_EQ(costs.latency_s, std::nullopt);
  EXPECT_FALSE(take_cost(costs, "cost latency 1e-6"));
  EXPECT_FALSE(take_cost(costs, "cost bandwidth 5e9"));
  EXPECT_TRUE(take_cost(costs, "done"));
  EXPECT_EQ(costs.waiting, 0.125);
  EXPECT_EQ(costs.packing, 0.5);
  EXPECT_EQ(costs.bytes, 4800);
  EXPECT_EQ(costs.messages, 2);
  EXPECT_EQ(costs.latency_s, 1e-6);
  EXPECT_EQ(costs.bytes_per_second, 5e9);
}

TEST(Answers, RefuseCostsThatCannotBe) {
  for (const char* line : {"cost waiting 1.5", "cost waiting -0.1", "cost bytes nan", "cost bytes inf",
                           "cost bytes", "cost joules 3", "price bytes 3", "done 0.5", "cost bytes 3 4"})
    EXPECT_THAT(complaint_about_cost(line), HasSubstr("where cost waiting")) << line;
  EXPECT_EQ(complaint_about_cost("failed the meter is broken"), "failed at \"costs\": the meter is broken");
}

TEST(Answers, SayThatARequestIsDone) {
  EXPECT_NO_THROW(take_done("get", "done", false));
  EXPECT_NO_THROW(take_done("step 3", "done 0.25", true));
  for (const char* line : {"done 0.25", "ready 1", "", "failed"})
    EXPECT_THROW(take_done("get", line, false), AnswerFailure) << line;
  EXPECT_THROW(take_done("step 3", "done -1", true), AnswerFailure);
  try {
    take_done("step 3", "hello", true);
  } catch (const AnswerFailure& failure) {
    EXPECT_THAT(failure.what(), StartsWith("answered \"hello\" to \"step 3\""));
  }
}

}  // namespace
}  // namespace mssim
