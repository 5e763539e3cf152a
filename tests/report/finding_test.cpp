#include "integrators/all_integrators.h"
#include "report/report_internal.h"
#include "scene/fields/fields.h"
#include "tests/support/report_fixture.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

ResultRow small(const std::string& backend, double ms, const std::string& integrator = "semi-euler") {
  return cloth_row(2500, 29004, backend, ms, integrator);
}
ResultRow larger(const std::string& backend, double ms) { return cloth_row(4900, 57404, backend, ms); }

/// With the papers' claims.
const ReportInput& claims_of_papers() {
  static const ReportInput input = [] {
    ReportInput all = of_papers();
    all.claims = published_claims();
    return all;
  }();
  return input;
}

/// The claim of that name, judged by these rows.
JudgedClaim judged(const std::string& name, const std::vector<ResultRow>& rows) {
  for (const JudgedClaim& one : judge(folder_of(rows, made_up_provenance()), claims_of_papers()))
    if (one.claim->name == name) return one;
  ADD_FAILURE() << "there is no claim " << name;
  return {};
}
ClaimOutcome outcome_of(const std::string& name, const std::vector<ResultRow>& rows) {
  return judged(name, rows).outcome;
}

/// A backend that is as many times as fast as another in each round, in turn.
ResultRow faster(ResultRow row, const ResultRow& than, const std::vector<double>& times) {
  row.samples_ms.clear();
  for (std::size_t round = 0; round < than.samples_ms.size(); ++round)
    row.samples_ms.push_back(than.samples_ms[round] / times[round % times.size()]);
  return row;
}

/// The row without its last round.
ResultRow in_five_rounds(ResultRow row) {
  row.rounds = 5;
  row.samples_ms.pop_back();
  return row;
}

TEST(Claims, AreNamedOnceAndEitherTestedOrNeedSomething) {
  std::set<std::string> names;
  for (const Claim& claim : published_claims()) {
    EXPECT_TRUE(names.insert(claim.name).second) << claim.name;
    EXPECT_TRUE(claim.test || !claim.needs.empty()) << claim.name;
    if (!claim.test) continue;
    for (const std::string& backend : {claim.test->fast, claim.test->slow})
      EXPECT_NE(std::ranges::find(legend.backends, backend, &PaperLegend::Backend::name),
                legend.backends.end())
          << claim.name;
    std::vector<std::string> integrators = claim.test->integrators;
    for (const std::string& one : {claim.test->slow_integrator, claim.test->gains_more_than})
      if (!one.empty()) integrators.push_back(one);
    for (const std::string& integrator : integrators) EXPECT_TRUE(find_integrator(integrator)) << claim.name;
  }
}

TEST(Claims, OfAFileThatIsNoneNameThePlace) {
  const auto refused = [](const std::string& text) {
    return sentence_of<SceneError>([&] { claims_in("claims.json", text); });
  };
  EXPECT_THAT(refused(R"({"claims": [{"name": "a", "paper": "Newton", "place": "1", "says": "b"}]})"),
              HasSubstr("/claims/0/paper"));
  EXPECT_THAT(refused(R"({"claims": [{"name": "a", "paper": "Vassilev", "place": "1", "say": "b"}]})"),
              HasSubstr("/claims/0/say"));
  EXPECT_THAT(refused(R"({"claims": [{"name": "a", "paper": "Vassilev", "place": "1", "says": "b",
                          "test": {"scenes": "table2", "fast": "a", "slow": "b", "at_least": 1}}]})"),
              AllOf(HasSubstr("/claims/0/test/scenes"), HasSubstr("figure6")));
}

TEST(Claims, HoldWhereEveryIntervalLiesAboveWhatTheyNeed) {
  const ResultRow serial = small("serial", 1), larger_serial = larger("serial", 1);
  const auto with = [&](const std::vector<double>& at_small, const std::vector<double>& at_larger) {
    return outcome_of("threads-before-cpu",
                      {serial, larger_serial, faster(small("threads-mutex", 1), serial, at_small),
                       faster(larger("threads-mutex", 1), larger_serial, at_larger)});
  };
  EXPECT_EQ(with({2, 2, 2}, {1.1, 1.2, 1.3}), ClaimOutcome::held);
  EXPECT_EQ(with({2, 2, 2}, {0.9, 1.2, 1.3}), ClaimOutcome::undecided);
  EXPECT_EQ(with({2, 2, 2}, {0.7, 0.8, 0.9}), ClaimOutcome::not_held);
  EXPECT_EQ(with({0.9, 2, 2}, {0.7, 0.8, 1.1}), ClaimOutcome::undecided);
}

TEST(Claims, AreUndecidedByTooFewRounds) {
  const ResultRow serial = in_five_rounds(small("serial", 1)), larger_serial = larger("serial", 1);
  for (const double times : {2.0, 0.5}) {
    const JudgedClaim claim = judged(
        "threads-before-cpu", {serial, larger_serial, faster(small("threads-mutex", 1), serial, {times}),
                               faster(larger("threads-mutex", 1), larger_serial, {2})});
    EXPECT_EQ(claim.outcome, ClaimOutcome::undecided) << times;
    EXPECT_THAT(claim.measured,
                AllOf(StartsWith("2.00×; 2 ratios"),  // without the other ratio
                      HasSubstr("1 undecided, 1 of these with too few rounds for an interval")));
  }
  const ResultRow body = in_five_rounds(cloth_row(3858, 72951, "serial", 1));
  const JudgedClaim mean =
      judged("threads-2-on-bodies", {body, faster(cloth_row(3858, 72951, "threads-mutex", 1), body, {3})});
  EXPECT_EQ(mean.outcome, ClaimOutcome::undecided);
  EXPECT_THAT(mean.measured, HasSubstr("geometric mean 3.00× (too few rounds for an interval)"));
}

TEST(Claims, OfARatioNeedAllOfIt) {
  const ResultRow serial = small("serial", 1);
  ResultRow gpu = faster(small("opencl", 1), serial, {10.1, 11, 12});
  gpu.device = "a GPU";
  EXPECT_EQ(outcome_of("gpu-10-to-34", {serial, gpu}), ClaimOutcome::held);
  gpu = faster(gpu, serial, {9.9, 11, 12});
  EXPECT_EQ(outcome_of("gpu-10-to-34", {serial, gpu}), ClaimOutcome::undecided);
  gpu = faster(gpu, serial, {9, 9.5, 9.9});
  EXPECT_EQ(outcome_of("gpu-10-to-34", {serial, gpu}), ClaimOutcome::not_held);
}

TEST(Claims, AboutAGpuAreNotDecidedOnTheProcessor) {
  const ResultRow serial = small("serial", 1);
  ResultRow opencl = faster(small("opencl", 1), serial, {20, 20, 20});
  opencl.device = "pthread-" + made_up_provenance().machine.cpu_model;
  const JudgedClaim claim = judged("gpu-10-to-34", {serial, opencl});
  EXPECT_EQ(claim.outcome, ClaimOutcome::not_testable);
  EXPECT_THAT(claim.measured, HasSubstr("a GPU"));
}

TEST(Claims, AboutThreadsAreNotDecidedByOne) {
  const ResultRow serial = small("serial", 1);
  ResultRow one = faster(small("threads-mutex", 1), serial, {0.5, 0.5, 0.5});
  one.threads = 1;
  const JudgedClaim claim = judged("threads-before-cpu", {serial, one});
  EXPECT_EQ(claim.outcome, ClaimOutcome::not_testable);
  EXPECT_THAT(claim.measured, HasSubstr("several threads"));
}

TEST(Claims, AboutThreadsAreDecidedByAsManyAsProcessors) {
  const ResultRow serial = small("serial", 1);
  const auto with = [&](double times, double times_on_ten) {
    return outcome_of(
        "threads-before-cpu",
        {serial, faster(small("threads-mutex", 1), serial, {times, times, times}),
         faster(small("threads-mutex:10", 1), serial, {times_on_ten, times_on_ten, times_on_ten})});
  };
  EXPECT_EQ(with(2, 0.5), ClaimOutcome::held);
  EXPECT_EQ(with(0.5, 2), ClaimOutcome::not_held);
}

TEST(Claims, AboutOneObjectAtATimeCompareWithAllTogether) {
  const auto row = [](const std::string& backend) { return cloth_row(3858, 72951, backend, 1); };
  const ResultRow each = row("threads-mutex:each");
  const auto with = [&](double times) {
    return judged("together-with-threads", {each, faster(row("threads-mutex"), each, {times, times, times})});
  };
  EXPECT_EQ(with(1.5).outcome, ClaimOutcome::held);
  EXPECT_EQ(with(0.9).outcome, ClaimOutcome::not_held);
  EXPECT_EQ(with(1.5).published, "") << "the paper has no such times";
  ResultRow hybrid_each = row("hybrid:each");
  ResultRow hybrid = faster(row("hybrid"), hybrid_each, {2, 2, 2});
  EXPECT_EQ(outcome_of("together-with-gpu", {hybrid_each, hybrid}), ClaimOutcome::held);
  for (ResultRow* one : {&hybrid, &hybrid_each})
    one->device = "pthread-" + made_up_provenance().machine.cpu_model;
  EXPECT_EQ(outcome_of("together-with-gpu", {hybrid_each, hybrid}), ClaimOutcome::not_testable);
}

TEST(Claims, OfAnAverageTakeTheGeometricMean) {
  const auto with = [](double first, double second) {
    std::vector<ResultRow> rows;
    for (const auto& [nodes, springs, times] :
         {std::tuple{3858U, 72951U, first}, std::tuple{4737U, 90045U, second}}) {
      const ResultRow serial = cloth_row(nodes, springs, "serial", 1);
      rows.push_back(serial);
      rows.push_back(faster(cloth_row(nodes, springs, "threads-mutex", 1), serial, {times, times, times}));
    }
    return judged("threads-2-on-bodies", rows);
  };
  EXPECT_EQ(with(1.5, 3).outcome, ClaimOutcome::held) << "2.12";
  EXPECT_EQ(with(1.2, 3).outcome, ClaimOutcome::not_held) << "1.90";
  EXPECT_THAT(with(1.5, 3).measured, HasSubstr("geometric mean 2.12"));
  EXPECT_THAT(with(1.5, 3).published, HasSubstr("geometric mean 1.5"));
}

TEST(Claims, AboutAGainCompareSpeedUps) {
  const ResultRow serial = small("serial", 1), serial_rk4 = small("serial", 4, "rk4");
  const auto in_rounds = [&](const std::vector<double>& gain, const std::vector<double>& gain_rk4) {
    std::vector<ResultRow> rows{serial, serial_rk4, faster(small("opencl", 1), serial, gain),
                                faster(small("opencl", 1, "rk4"), serial_rk4, gain_rk4)};
    for (ResultRow& row : rows)
      if (row.backend == "opencl") row.device = "a GPU";
    return judged("rk4-gains-more", rows);
  };
  const auto with = [&](double gain, double gain_rk4) {
    return in_rounds(std::vector<double>(3, gain), std::vector<double>(3, gain_rk4));
  };
  EXPECT_EQ(with(10, 15).outcome, ClaimOutcome::held);
  EXPECT_EQ(with(10, 9).outcome, ClaimOutcome::not_held);
  EXPECT_EQ(in_rounds({8, 10, 12}, {11, 12, 13}).outcome, ClaimOutcome::undecided) << "11 over 12 at least";
  // 23.954 / 1.688 over 19.475 / 1.827 at 2,500 nodes is the largest of the six, 399.049 / 22.393 over
  // 331.933 / 20.264 the least.
  EXPECT_THAT(with(10, 15).published, HasSubstr("1.09× to 1.33× (6 ratios)"));
}

TEST(Claims, OfGarmentsAreDecidedByThePublishedAlgorithmOnEachGarment) {
  const auto jeans = [](const std::string& backend, std::uint64_t nodes, double ms) {
    ResultRow row = cloth_row(nodes, 1, backend, ms);
    row.scene = "jeans" + std::to_string(nodes);
    row.springs_published.reset();
    row.dressing.emplace();
    return row;
  };
  const auto outcome = [&](double small_ms, double large_ms, int threads) {
    std::vector<ResultRow> rows{jeans("algorithm1-simd", 1000, 1), jeans("algorithm1-simd", 4000, 4),
                                jeans("algorithm1-threads-simd", 1000, small_ms),
                                jeans("algorithm1-threads-simd", 4000, large_ms)};
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i].threads = i < 2 ? 1 : threads;
    EXPECT_EQ(outcome_of("simd-is-faster", rows), ClaimOutcome::not_testable) << "without rows without SIMD";
    EXPECT_EQ(outcome_of("parallel-on-device", rows), ClaimOutcome::not_testable);
    return outcome_of("parallel-iterations", rows);
  };
  EXPECT_EQ(outcome(0.5, 2, 2), ClaimOutcome::held);
  EXPECT_EQ(outcome(1.5, 2, 2), ClaimOutcome::not_held) << "of the smaller one";
  EXPECT_EQ(outcome(0.5, 2, 1), ClaimOutcome::not_testable) << "one thread is not parallel";
  std::vector<ResultRow> rows{jeans("algorithm1", 1000, 1.5), jeans("algorithm1-simd", 1000, 1)};
  EXPECT_EQ(outcome_of("simd-is-faster", rows), ClaimOutcome::held);
  for (ResultRow& row : rows) row.scene_as_shipped = false;
  EXPECT_TRUE(judge(folder_of(rows), claims_of_papers()).empty());
}

TEST(Claims, AreNoneWithoutAPublishedSceneAndSayWhichRowsAreMissing) {
  ResultRow other = small("serial", 1);
  other.nodes = 2501;
  EXPECT_TRUE(judge(folder_of({other}), claims_of_papers()).empty());
  const JudgedClaim missing = judged("threads-before-cpu", {small("serial", 1)});
  EXPECT_EQ(missing.outcome, ClaimOutcome::not_testable);
  EXPECT_THAT(missing.measured, HasSubstr("`threads-mutex`"));
  std::vector<ResultRow> rows{small("serial", 1), small("threads-mutex", 0.1)};
  rows[1].verified = false;
  EXPECT_EQ(outcome_of("threads-before-cpu", rows), ClaimOutcome::not_testable);
}

/// Is the one finding that holds a text a warning?
bool warns(const std::vector<Finding>& findings, const std::string& text) {
  const auto holds = [&](const Finding& finding) { return finding.sentence.find(text) != std::string::npos; };
  EXPECT_EQ(std::ranges::count_if(findings, holds), 1) << text;
  const auto found = std::ranges::find_if(findings, holds);
  return found != findings.end() && found->is_warning;
}

TEST(RowFindings, NameRowsThatAreNotVerified) {
  std::vector<ResultRow> rows{small("serial", 1), small("openmp", 0.5)};
  const Provenance provenance = made_up_provenance();
  EXPECT_FALSE(warns(row_findings(rows, provenance), "2 rows have a time, and all are verified"));
  rows[1].verified = false;
  EXPECT_TRUE(
      warns(row_findings(rows, provenance), ": `openmp` on `cloth2500`, semi-euler (failed: not verified)."));
  rows[1] = failed_row("openmp", "failed: it deviates");
  EXPECT_TRUE(
      warns(row_findings(rows, provenance), ": `openmp` on `cloth2500`, semi-euler (failed: it deviates)."));
  EXPECT_FALSE(warns(row_findings(rows, provenance), "1 row has a time, and is verified"));
  rows[1] = failed_row("openmp", "unavailable: no device");
  EXPECT_FALSE(warns(row_findings(rows, provenance), "1 row has no time"));
  EXPECT_TRUE(row_findings({}, provenance).empty());
}

TEST(RowFindings, NameOneRowForEachReason) {
  std::vector<ResultRow> rows(4, failed_row("openmp", "failed: it deviates"));
  rows.push_back(failed_row("opencl", "failed: step 3"));
  const auto only_warning = [&](const std::string& end) {
    return warns(row_findings(rows, made_up_provenance()), " all statistics: " + end);
  };
  EXPECT_TRUE(only_warning(
      "`openmp` on `cloth2500`, semi-euler and 3 more (failed: it deviates); `opencl` on `cloth2500`, "
      "semi-euler (failed: step 3)."));
  for (int step = 4; step < 8; ++step)
    rows.push_back(failed_row("opencl", fmt::format("failed: step {}", step)));
  EXPECT_TRUE(
      warns(row_findings(rows, made_up_provenance()),
            "semi-euler (failed: step 4); the list *Rows without a time* has 3 rows with other reasons."));
}

TEST(RowFindings, SayOfHowManyRowsTheSamplesAreNotChecked) {
  std::vector<ResultRow> rows{small("serial", 1), small("openmp", 0.5)};
  rows[1].note = "a remark; " + std::string(unchecked_samples);
  EXPECT_FALSE(warns(row_findings(rows, made_up_provenance()),
                     "reference, but the samples of 1 row are not checked yet."));
}

TEST(RowFindings, NameSpeedUpsThatMayBeOne) {
  std::vector<ResultRow> rows{small("serial", 1), small("openmp", 0.5)};
  EXPECT_FALSE(warns(row_findings(rows, {}), "1 speed-up over `serial`: no interval"));
  rows[1].samples_ms = {3, 0.25, 1, 3, 0.25, 1};
  EXPECT_FALSE(warns(row_findings(rows, {}), "`openmp` on `cloth2500`, semi-euler (0.667 to 2.00)."));
  for (ResultRow& row : rows) row = in_five_rounds(row);
  EXPECT_FALSE(warns(row_findings(rows, {}),
                     "1 speed-up over `serial`. 1 speed-up has too few rounds for a 95 % interval."));
  rows.erase(rows.begin());
  EXPECT_FALSE(warns(row_findings(rows, {}), "There are no speed-ups"));
}

TEST(TimesAsFast, TakesTheIntervalsOfTimesWhereThereAreNoPairs) {
  ResultRow row = small("openmp", 1), than = small("serial", 4);
  EXPECT_EQ(times_as_fast(&row, &than)->low, 4);
  EXPECT_TRUE(times_as_fast(&row, &than)->covers);
  row.samples_ms.pop_back();
  const auto ratio = times_as_fast(&row, &than);
  EXPECT_EQ(ratio->ratio, 4);
  EXPECT_EQ(ratio->low, 1);
  EXPECT_EQ(ratio->high, 16);
  EXPECT_TRUE(ratio->covers);
  than.rounds = 5;
  EXPECT_FALSE(times_as_fast(&row, &than)->covers);
  than.rounds = 6;
  row.ms_per_step_low = row.ms_per_step_high = std::nullopt;
  EXPECT_EQ(times_as_fast(&row, &than)->low, 2);
  EXPECT_FALSE(times_as_fast(&row, &than)->covers);
  row.verified = false;
  EXPECT_FALSE(times_as_fast(&row, &than));
}

TEST(TimesOf, ShowsNoIntervalOfTooFewRounds) {
  ReportFolder folder = folder_of({small("serial", 1), small("openmp", 0.5)});
  const auto text = [&] { return to_text(times_of(pointers_to(folder.rows), folder), ListingFormat::csv); };
  EXPECT_THAT(text(), HasSubstr("0.250 to 1.00,2.0,2.00 to 2.00,"));
  for (ResultRow& row : folder.rows) row = in_five_rounds(row);
  EXPECT_THAT(text(), HasSubstr("cloth2500,0.5,openmp,semi-euler,2,,2.0,,19.475,"));
}

TEST(TimesOf, MarksARatioThatItsTimesContradict) {
  ReportFolder folder = folder_of({small("serial", 1), small("openmp", 0.5)});
  const auto text = [&] { return markdown({times_of(pointers_to(folder.rows), folder)}); };
  EXPECT_THAT(text(), HasSubstr("| 2.00× |"));
  folder.rows[1].ms_per_step = 1.01;
  EXPECT_THAT(text(), HasSubstr("| 2.00×† |"));
}

TEST(ExponentOf, IsTheSlopeOnLogarithmicAxes) {
  const std::vector<double> x{1, 10, 100}, y{5, 500, 50000};
  EXPECT_NEAR(*exponent_of(x, y), 2, 1e-12);
  EXPECT_FALSE(exponent_of(std::vector<double>{3, 3}, std::vector<double>{1, 2}));
  EXPECT_FALSE(exponent_of({}, {}));
}

}  // namespace
}  // namespace mssim
