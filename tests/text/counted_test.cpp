#include <gtest/gtest.h>

#include "text/text.h"

namespace mssim {
namespace {

TEST(Counted, HasAPluralButForOne) {
  EXPECT_EQ(pluralize(0, "row"), "0 rows");
  EXPECT_EQ(pluralize(1, "thread"), "1 thread");
  EXPECT_EQ(pluralize(2, "logical CPU"), "2 logical CPUs");
}

}  // namespace
}  // namespace mssim
