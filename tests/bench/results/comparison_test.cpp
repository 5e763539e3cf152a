#include "bench/results/comparison.h"

#include "tests/support/result_fixture.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

/// A row of `count` samples about `ms`, spread evenly over plus and minus `spread`.
ResultRow row_of(const std::string& backend, double ms, double spread = 0.02, int count = 15) {
  ResultRow row = measured_row(backend, ms, std::nullopt);
  row.samples_ms.clear();
  for (int i = 0; i < count; ++i) row.samples_ms.push_back(ms * (1 + spread * (2. * i / (count - 1) - 1)));
  row.sample_steps.assign(row.samples_ms.size(), 10);
  return row;
}

ComparedRow compared(const ResultRow& base, const ResultRow& next) {
  const RunComparison comparison = compare(std::vector{base}, std::vector{next}, threshold);
  EXPECT_EQ(comparison.rows.size(), 1U);
  return comparison.rows.at(0);
}

/// Two rows of openmp with as many samples, spread alike.
ComparedRow compared(double base_ms, double new_ms, double spread = 0.02, int count = 15) {
  return compared(row_of("openmp", base_ms, spread, count), row_of("openmp", new_ms, spread, count));
}

TEST(Verdict, OfATimeThatRoseBeyondTheThresholdIsSlower) {
  const ComparedRow row = compared(1, 1.1);
  EXPECT_EQ(row.verdict, Verdict::slower);
  EXPECT_NEAR(row.ratio->ratio, 1.1, 0.01);
  EXPECT_LT(row.ratio->p, significance);
  EXPECT_EQ(row.samples_needed, std::nullopt);
}

TEST(Verdict, OfATimeThatFellBeyondTheThresholdIsFaster) {
  EXPECT_EQ(compared(1.1, 1).verdict, Verdict::faster);
}

TEST(Verdict, OfASmallChangeIsSameThoughItIsSignificant) {
  const ComparedRow row = compared(1, 1.03, 0.01);
  EXPECT_LT(row.ratio->p, significance);
  EXPECT_EQ(row.verdict, Verdict::same);
}

TEST(Verdict, OfARunWithItselfIsSame) { EXPECT_EQ(compared(1, 1).verdict, Verdict::same); }

TEST(Verdict, OfNoisyTimesIsUndecidedAndSaysHowManyWouldDo) {
  const ComparedRow row = compared(1, 1.01, 0.3);
  EXPECT_EQ(row.verdict, Verdict::undecided);
  ASSERT_TRUE(row.samples_needed);
  EXPECT_GT(*row.samples_needed, 50U);
  EXPECT_LT(*row.samples_needed, 500U);
}

TEST(Verdict, OfAChangeAtTheThresholdItselfWouldNeedManySamples) {
  const ComparedRow row = compared(1, 1.0499, 0.3);
  EXPECT_EQ(row.verdict, Verdict::undecided);
  EXPECT_EQ(row.samples_needed, std::nullopt);
}

TEST(Verdict, IsByTheThresholdUpOrDownByTheSameFactor) {
  // 1.05 up, 1 / 1.05 = 0.95238 down.
  const auto verdict = [](double ratio, double low, double high, double p = 0.009) {
    return verdict_of({ratio, low, high, true, p}, 0.05);
  };
  EXPECT_EQ(verdict(1.051, 1.02, 1.08), Verdict::slower);
  EXPECT_EQ(verdict(1.049, 1.02, 1.08), Verdict::undecided);
  EXPECT_EQ(verdict(0.952, 0.93, 0.98), Verdict::faster);
  EXPECT_EQ(verdict(0.953, 0.93, 0.98), Verdict::undecided);
  EXPECT_EQ(verdict(1.2, 1.1, 1.3, 0.0101), Verdict::undecided) << "a difference that is not significant";
  EXPECT_EQ(verdict(1, 0.953, 1.049, 1), Verdict::same);
  EXPECT_EQ(verdict(1, 0.952, 1.049, 1), Verdict::undecided);
  EXPECT_EQ(verdict(1, 0.953, 1.051, 1), Verdict::undecided);
  const auto certain = [](double low, double high) {
    return is_certain({(low + high) / 2, low, high, true, 0.009}, 0.05);
  };
  EXPECT_TRUE(certain(1.051, 1.3));
  EXPECT_FALSE(certain(1.049, 1.3));
  EXPECT_TRUE(certain(0.8, 0.952));
  EXPECT_FALSE(certain(0.8, 0.953));
}

TEST(SamplesNeeded, AreAsManyMoreAsTheIntervalIsTooWideSquared) {
  // No change: half of the interval is ln 1.2 = 0.18232 wide and may be ln 1.05 = 0.04879: 3.7369 times too
  // wide, which ten samples times 13.964 mend.
  EXPECT_EQ(samples_needed({1, 1 / 1.2, 1.2, true, 1}, 10, 0.05), 140U);
  // 1.02 leaves ln 1.05 - ln 1.02 = 0.028988 of the margin: (0.18232 / 0.028988)^2 = 39.56.
  EXPECT_EQ(samples_needed({1.02, 1.02 / 1.2, 1.02 * 1.2, true, 1}, 10, 0.05), 396U);
  // A change of ln 1.2 beyond the margin is significant where the interval is 1.96 / 2.58 of it wide,
  // 0.13851: half of it is ln 1.3 = 0.26236, (0.26236 / 0.13851)^2 = 3.588.
  EXPECT_EQ(samples_needed({1.2, 1.2 / 1.3, 1.2 * 1.3, true, 0.1}, 10, 0.05), 36U);
  // Nobody takes more than 1,000: 71 times 13.964 is 991.5, 72 times 1005.4.
  EXPECT_EQ(samples_needed({1, 1 / 1.2, 1.2, true, 1}, 71, 0.05), 992U);
  EXPECT_EQ(samples_needed({1, 1 / 1.2, 1.2, true, 1}, 72, 0.05), std::nullopt);
  EXPECT_EQ(samples_needed({1, 0.99, 1.01, true, 1}, 20, 0.05), 21U) << "one more at least";
}

TEST(Verdict, OfFewSamplesIsUndecidedHoweverFarApart) {
  const ComparedRow row = compared(1, 2, 0.01, 3);
  EXPECT_EQ(row.verdict, Verdict::undecided);
  EXPECT_EQ(row.samples_needed, 5U);
  EXPECT_EQ(compared(1, 2, 0.01, 5).verdict, Verdict::slower);
  // Three samples that agree have no 95 % interval, so they are not the same either.
  EXPECT_EQ(compared(1, 1, 0, 3).verdict, Verdict::undecided);
}

TEST(RunComparison, CallsARowLostThatHasNoTimeAnyMore) {
  const ComparedRow failed = compared(row_of("openmp", 1), failed_row("openmp", "failed: step 3"));
  EXPECT_EQ(failed.verdict, Verdict::lost);
  EXPECT_EQ(failed.reason, "failed: step 3");
  EXPECT_EQ(failed.new_ms, std::nullopt);
  ResultRow unverified = row_of("openmp", 1);
  unverified.verified = false;
  EXPECT_EQ(compared(row_of("openmp", 1), unverified).reason, "failed: not verified");
}

TEST(RunComparison, NamesWhatItLeavesOut) {
  const std::vector<ResultRow> base{row_of("openmp", 1), row_of("serial", 1),
                                    failed_row("opencl", "unavailable: x")};
  const std::vector<ResultRow> next{row_of("hybrid", 1), row_of("openmp", 1), row_of("opencl", 1)};
  const RunComparison comparison = compare(base, next, threshold);
  ASSERT_EQ(comparison.rows.size(), 1U);
  EXPECT_EQ(comparison.rows[0].backend, "openmp");
  EXPECT_THAT(comparison.only_base, ElementsAre("cloth2500, serial, semi-euler"));
  EXPECT_THAT(comparison.only_new, ElementsAre("cloth2500, hybrid, semi-euler"));
  EXPECT_THAT(comparison.untimed, ElementsAre("cloth2500, opencl, semi-euler"));
}

TEST(RunComparison, MeansRatiosOverAllAndByBackend) {
  std::vector<ResultRow> base{row_of("openmp", 1), row_of("openmp", 1), row_of("serial", 1),
                              row_of("opencl", 1)};
  base[1].integrator = "rk4";
  std::vector<ResultRow> next{row_of("openmp", 2), row_of("openmp", 8), row_of("serial", 0.5),
                              failed_row("opencl", "failed: x")};
  next[1].integrator = "rk4";
  const RunComparison comparison = compare(base, next, threshold);
  ASSERT_EQ(comparison.means.size(), 3U);
  EXPECT_EQ(comparison.means[0].backend, "");
  EXPECT_EQ(comparison.means[0].rows, 3U);
  EXPECT_NEAR(comparison.means[0].ratio, 2, 1e-12);
  EXPECT_EQ(comparison.means[1].backend, "openmp");
  EXPECT_NEAR(comparison.means[1].ratio, 4, 1e-12);
  EXPECT_NEAR(comparison.means[2].ratio, 0.5, 1e-12);
}

TEST(RunComparison, IsARegressionWhereARowIsSlowerOrLost) {
  const auto regression = [](const ResultRow& next) {
    return has_regression(compare(std::vector{row_of("openmp", 1)}, std::vector{next}, threshold));
  };
  EXPECT_FALSE(regression(row_of("openmp", 1)));
  EXPECT_FALSE(regression(row_of("openmp", 0.5)));
  EXPECT_FALSE(regression(row_of("openmp", 1, 0.5)));
  EXPECT_TRUE(regression(row_of("openmp", 2)));
  EXPECT_TRUE(regression(failed_row("openmp", "failed: x")));
  EXPECT_THAT(compare({}, {}, threshold).rows, IsEmpty());
}

TEST(Comparability, OfARunWithItselfIsGiven) {
  Provenance provenance = made_up_provenance();
  add_scene(provenance, "cloth2500", "text");
  EXPECT_THAT(differences(provenance, provenance), IsEmpty());
  EXPECT_THAT(differences(table_rows(), table_rows()), IsEmpty());
}

TEST(Comparability, DependsOnTheFilesOfASceneWhereBothAreKnown) {
  Provenance one = made_up_provenance(), other = one, unknown = one;
  add_scene(one, "mine", "text", 1);
  add_scene(other, "mine", "text", 2);
  add_scene(unknown, "mine", "text");
  EXPECT_THAT(differences(one, one), IsEmpty());
  EXPECT_THAT(differences(one, unknown), IsEmpty());
  EXPECT_THAT(differences(one, other),
              ElementsAre("the hash of the files of scene mine was 0000000000000001 and is "
                          "0000000000000002"));
}

TEST(Comparability, DoesNotDependOnWhatAMachineDoesFromDayToDay) {
  Provenance later = made_up_provenance();
  later.machine.load_average = {7, 7, 7};
  later.machine.cpu_mhz = 1000;
  later.started_utc = "2027-01-31T12:00:00Z";
  later.build.commit = "another";
  later.build.dirty = false;
  later.command_line = {"mssim", "bench", "--out", "x"};
  EXPECT_THAT(differences(made_up_provenance(), later), IsEmpty());
}

TEST(Comparability, SaysWhatDiffers) {
  Provenance other = made_up_provenance();
  other.machine.logical_cpus = 4;
  other.build.compiler = "Clang 14";
  other.build.build_type = "Debug";
  other.build.flags = "-O0";
  other.threads = 3;
  EXPECT_THAT(
      differences(made_up_provenance(), other),
      ElementsAre("the CPU was A Processor with 2 logical CPUs and is A Processor with 4 logical CPUs",
                  "the compiler was GNU 12 and is Clang 14", "the build type was Release and is Debug",
                  "the list of compiler flags was \"-O3\" and is \"-O0\"",
                  "the number of threads was 2 and is 3"));
  other = made_up_provenance();
  other.machine.cpu_model = "Another";
  EXPECT_THAT(differences(other, made_up_provenance()),
              ElementsAre("the CPU was Another with 2 logical CPUs and is A Processor with 2 logical CPUs"));
}

TEST(Comparability, TellsDesignsOfOneNameApartWhereBothAreKnown) {
  Provenance zen4 = made_up_provenance(), zen5 = made_up_provenance();
  zen4.machine.cpu_generation = "Zen 4";
  zen5.machine.cpu_generation = "Zen 5";
  EXPECT_THAT(differences(zen4, zen5),
              ElementsAre("the CPU was A Processor, Zen 4 with 2 logical CPUs and is "
                          "A Processor, Zen 5 with 2 logical CPUs"));
  EXPECT_THAT(differences(made_up_provenance(), zen5), testing::IsEmpty());
}

TEST(Comparability, HoldsAgainstEachOtherOnlyScenesThatBothHave) {
  Provenance before = made_up_provenance(), now = made_up_provenance();
  before.scenes = {{"a", 1}, {"b", 2}, {"c", 3}};
  now.scenes = {{"d", 4}, {"c", 3}, {"b", 0xabc}};
  EXPECT_THAT(differences(before, now),
              ElementsAre("the hash of scene b was 0000000000000002 and is 0000000000000abc"));
}

TEST(Comparability, SaysOnceThatABackendRanOnAnotherDevice) {
  std::vector<ResultRow> before{measured_row("opencl", 1, {}), measured_row("opencl", 2, {}),
                                measured_row("serial", 3, {})};
  before[1].integrator = "rk4";
  std::vector<ResultRow> now = before;
  now[0].device = now[1].device = "a GPU";
  EXPECT_THAT(differences(before, now), ElementsAre("the device of opencl was cpu and is a GPU"));
}

TEST(Comparability, SaysThatABackendRanWithOtherThreads) {
  const std::vector<ResultRow> before{measured_row("opencl", 1, {})};
  std::vector<ResultRow> now = before;
  now[0].threads = before[0].threads + 1;
  EXPECT_THAT(differences(before, now),
              ElementsAre(fmt::format("the number of threads of opencl was {} and is {}", before[0].threads,
                                      now[0].threads)));
}

TEST(Comparability, SaysThatASceneCameOutOtherwise) {
  const std::vector<ResultRow> before{measured_row("openmp", 1, {})};
  std::vector<ResultRow> now = before;
  now[0].springs_unique = 14503;
  EXPECT_THAT(
      differences(before, now),
      ElementsAre(
          "scene cloth2500 was one of 2500 nodes and 14502 springs and is one of 2500 nodes and 14503 "
          "springs"));
}

TEST(Comparability, LeavesOutRowsThatOneRunOnlyHasOrDidNotMeasure) {
  const std::vector<ResultRow> before{measured_row("openmp", 1, {}), measured_row("opencl", 1, {})};
  std::vector<ResultRow> now{measured_row("hybrid", 1, {}), failed_row("opencl", "unavailable: no device")};
  for (ResultRow& row : now) row.device = "another";
  EXPECT_THAT(differences(before, now), IsEmpty());
}

}  // namespace
}  // namespace mssim
