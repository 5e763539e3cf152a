#include <gtest/gtest.h>

#include "text/text.h"

namespace mssim {
namespace {

TEST(Hash, EqualsThePublishedTestVectors) {
  // From the FNV draft's appendix.
  EXPECT_EQ(fnv1a_64(""), 0xcbf29ce484222325U);
  EXPECT_EQ(fnv1a_64("a"), 0xaf63dc4c8601ec8cU);
  EXPECT_EQ(fnv1a_64("foobar"), 0x85944171f73967e8U);
}

TEST(Hash, IsWrittenWithAllItsDigits) { EXPECT_EQ(to_hex(0x0123456789abcdefU), "0123456789abcdef"); }

}  // namespace
}  // namespace mssim
