#include "bench/results/result.h"

#include "tests/support/testing.h"

namespace mssim {
namespace {

TEST(Summarise, WorksOutWhatFollowsFromTheSamples) {
  ResultRow row, serial;
  row.integrator = "rk4";
  row.springs_unique = 1000;
  row.samples_ms = {2, 1, 4};
  serial.samples_ms = {10, 1, 4};
  summarise(row, &serial);
  EXPECT_EQ(row.ms_per_step, 2);
  EXPECT_EQ(row.ms_per_step_min, 1);
  // 1,000 springs in each of 4 stages, in 2 ms.
  EXPECT_EQ(row.springs_per_second, 2e6);
  // Of the rounds' ratios 5, 1 and 1; that of the medians would be 2.
  EXPECT_EQ(row.speedup_vs_serial, 1);
  serial.samples_ms.pop_back();
  row.speedup_vs_serial.reset();
  row.springs_per_second.reset();
  row.integrator = "implicit-euler";
  summarise(row, &serial);
  EXPECT_FALSE(row.speedup_vs_serial) << "there are no pairs";
  EXPECT_FALSE(row.springs_per_second) << "nobody counts the products of conjugate gradients";
}

TEST(RequireFinite, FailsARowByAnyNumberOfItsColumns) {
  std::size_t numbers = 0;
  for (const ResultColumn& column : result_columns)
    if (const auto* number = std::get_if<std::optional<double> ResultRow::*>(&column.value)) {
      ResultRow row;
      row.verified = true;
      row.** number = std::numeric_limits<double>::infinity();
      require_finite(row);
      EXPECT_EQ(row.status, "failed: " + std::string(column.name) + " is not finite");
      EXPECT_FALSE(row.**number || row.verified) << column.name;
      ++numbers;
    }
  EXPECT_GE(numbers, 18U);
  ResultRow row;
  row.position_error = 1e301;
  require_finite(row);
  EXPECT_EQ(row.status, "failed: position_error is beyond 1e300");
}

}  // namespace
}  // namespace mssim
