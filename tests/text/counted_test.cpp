#include "text/counted.h"

#include <gtest/gtest.h>

namespace mssim {
namespace {

TEST(Counted, HasAPluralButForOne) {
  EXPECT_EQ(counted(0, "row"), "0 rows");
  EXPECT_EQ(counted(1, "thread"), "1 thread");
  EXPECT_EQ(counted(2, "logical CPU"), "2 logical CPUs");
}

}  // namespace
}  // namespace mssim
