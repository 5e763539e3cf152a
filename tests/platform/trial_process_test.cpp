#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <stdexcept>

#include "platform/process.h"

namespace mssim {
namespace {

TEST(TrialProcess, SaysWhetherWorkEndsAndChangesNothingHere) {
  int here = 0;
  EXPECT_TRUE(ends_in_trial([&] { here = 1; }, 10));
  EXPECT_TRUE(ends_in_trial([] { throw std::runtime_error("refused"); }, 10));
  EXPECT_EQ(here, 0);
  for (const int crash : {SIGSEGV, SIGFPE, SIGABRT})
    EXPECT_FALSE(ends_in_trial([&] { std::raise(crash); }, 10)) << crash;
}

TEST(TrialProcess, EndsWorkThatDoesNot) {
  volatile bool goes_on = true;
  EXPECT_FALSE(ends_in_trial(
      [&] {
        while (goes_on) {
        }
      },
      1));
}

}  // namespace
}  // namespace mssim
