#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "application/bench/bench_run.h"

namespace mssim {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

ResultRow row(const std::string& backend, const std::string& status, bool verified) {
  ResultRow row;
  row.scene = "cloth";
  row.backend = backend;
  row.integrator = "rk4";
  row.status = status;
  row.verified = verified;
  return row;
}

TEST(BenchVerdict, IsGoodWhereEveryRowThatWasAskedForIsVerified) {
  const BenchVerdict verdict = verdict_of(
      {row("serial", "ok", true), row("opencl", "unavailable: no device", false)}, {"serial"}, {"rk4"});
  EXPECT_EQ(verdict.exit_code, exit_ok);
  EXPECT_THAT(verdict.reasons, IsEmpty());
}

TEST(BenchVerdict, NamesTheRowsThatAreWrongBeforeThoseThatAreMissing) {
  const BenchVerdict verdict =
      verdict_of({row("serial", "ok", true), row("openmp", "failed: off by 1", false),
                  row("hybrid", "ok", false), row("opencl", "unavailable: no device", false)},
                 {"opencl"}, {});
  EXPECT_EQ(verdict.exit_code, exit_not_verified);
  EXPECT_THAT(verdict.reasons, ElementsAre("cloth, openmp, rk4: failed: off by 1",
                                           "cloth, hybrid, rk4: failed: not verified"));
}

TEST(BenchVerdict, NamesWhatWasAskedForAndCouldNotRun) {
  const std::vector<ResultRow> rows{row("serial", "ok", true),
                                    row("opencl", "unavailable: no device", false)};
  const BenchVerdict verdict = verdict_of(rows, {"serial", "opencl"}, {});
  EXPECT_EQ(verdict.exit_code, exit_unavailable);
  EXPECT_THAT(verdict.reasons, ElementsAre("cloth, opencl, rk4: unavailable: no device"));
  EXPECT_EQ(verdict_of({rows[1]}, {}, {"rk4"}).exit_code, exit_unavailable);
}

}  // namespace
}  // namespace mssim
