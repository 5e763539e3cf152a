#include <gtest/gtest.h>

#include "platform/machine.h"

namespace mssim {
namespace {

TEST(MemoryShortage, IsNoneWhereTheMemorySuffices) {
  EXPECT_FALSE(memory_shortage(1000, 1000));
  EXPECT_FALSE(memory_shortage(0, available_memory()));
}

TEST(MemoryShortage, NamesBothInTwoDigitsWhereTheseTellThemApart) {
  EXPECT_EQ(memory_shortage(3'200'000'000, 1'000'000'000),
            "needs at least 3.20 GB of memory, but 1.00 GB are available");
}

TEST(MemoryShortage, TakesAsManyDigitsAsTellTheTwoApart) {
  EXPECT_EQ(memory_shortage(384'000'000, 379'000'000),
            "needs at least 0.384 GB of memory, but 0.379 GB are available");
  EXPECT_EQ(memory_shortage(1'000'000'001, 1'000'000'000),
            "needs at least 1.000000001 GB of memory, but 1.000000000 GB are available");
}

}  // namespace
}  // namespace mssim
