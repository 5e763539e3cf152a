#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "output/tables/results.h"
#include "output/tables/table.h"
#include "tests/support/result_fixture.h"
#include "tests/support/temporary_folder.h"

namespace mssim {
namespace {

using CombinationTimes = TemporaryFolderTest;

TEST_F(CombinationTimes, AreThoseOfWhatWasVerified) {
  std::vector<ResultRow> rows{measured_row("serial", 0.25, 1.0), measured_row("openmp", 0.5, 2.0),
                              failed_row("opencl", "unavailable: no device")};
  rows[1].verified = false;
  const auto times = read_combination_times(put("timings.csv", timings_csv(rows)));
  ASSERT_EQ(times.size(), 3U);
  EXPECT_EQ(times[0].scene, "cloth2500");
  EXPECT_EQ(times[0].backend, "serial");
  EXPECT_EQ(times[0].integrator, "semi-euler");
  EXPECT_EQ(times[0].least_ms, 0.125);
  EXPECT_EQ(times[1].least_ms, std::nullopt);
  EXPECT_EQ(times[1].status, "failed: not verified");
  EXPECT_EQ(times[2].least_ms, std::nullopt);
  EXPECT_EQ(times[2].status, "unavailable: no device");
}

TEST_F(CombinationTimes, AreFoundWhateverElseAVersionWritesAndInWhichOrder) {
  const auto times = read_combination_times(
      put("timings.csv",
          "new,status,verified,ms_per_step_min,integrator,backend,scene\n7,ok,true,1.5,rk4,hybrid,mine\n"));
  ASSERT_EQ(times.size(), 1U);
  EXPECT_EQ(times[0].scene, "mine");
  EXPECT_EQ(times[0].least_ms, 1.5);
}

TEST_F(CombinationTimes, AreRefusedWhereOneIsMissingOrNoTime) {
  const std::string header = "scene,backend,integrator,ms_per_step_min,verified,status\n";
  const auto refusal = [&](const std::string& text) {
    try {
      read_combination_times(put("timings.csv", text));
    } catch (const CsvError& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  EXPECT_THAT(refusal("scene,backend\n"), testing::HasSubstr("there is no column integrator"));
  EXPECT_THAT(refusal(header + "a,b,c,0,true,ok\n"), testing::HasSubstr("\"0\" is not a time above zero"));
  EXPECT_THAT(refusal(header + "a,b,c,nan,true,ok\n"), testing::HasSubstr("\"nan\" is not a number"));
  EXPECT_THAT(refusal(header + "a,b,c,,true,ok\n"), testing::HasSubstr("ms_per_step"));
  EXPECT_EQ(refusal(header + "a,b,c,,false,failed: x\n"), "none");
}

}  // namespace
}  // namespace mssim
