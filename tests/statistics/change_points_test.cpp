#include <iostream>

#include "output/folders/result_folder.h"
#include "statistics/statistics.h"
#include "tests/support/files_fixture.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

/// `count` times around `ms`, which differ by up to 1 %.
std::vector<double> level(double ms, std::size_t count) {
  std::vector<double> times;
  for (std::size_t i = 0; i < count; ++i)
    times.push_back(ms * (1 + 0.01 * std::sin(static_cast<double>(7 * i * i + 3))));
  return times;
}

std::vector<double> joined(std::vector<double> first, const std::vector<double>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

TEST(ChangePoints, AreWhereTheLevelsMeet) {
  const std::vector<double> times = joined(joined(level(2, 12), level(2.2, 9)), level(1.1, 10));
  const std::vector<ChangePoint> changes = change_points(times);
  ASSERT_EQ(changes.size(), 2U);
  EXPECT_EQ(changes[0].first, 12U);
  EXPECT_EQ(changes[1].first, 21U);
  EXPECT_NEAR(changes[0].ratio.ratio, 1.1, 0.01);
  EXPECT_NEAR(changes[1].ratio.ratio, 0.5, 0.005);
  for (const ChangePoint& change : changes) {
    EXPECT_LT(change.ratio.low, change.ratio.ratio);
    EXPECT_GT(change.ratio.high, change.ratio.ratio);
    EXPECT_TRUE(change.ratio.covers);
  }
}

TEST(ChangePoints, AreFoundThoughALaterOneTakesThemBack) {
  const std::vector<double> repaired = joined(joined(level(2, 20), level(2.6, 15)), level(2, 20));
  const std::vector<ChangePoint> both = change_points(repaired);
  ASSERT_EQ(both.size(), 2U);
  EXPECT_EQ(both[0].first, 20U);
  EXPECT_EQ(both[1].first, 35U);
  // Nor do they hide a new one.
  const std::vector<ChangePoint> three = change_points(joined(repaired, level(2.2, 5)));
  ASSERT_EQ(three.size(), 3U);
  EXPECT_EQ(three[2].first, 55U);
  EXPECT_NEAR(three[2].ratio.ratio, 1.1, 0.01);
}

TEST(ChangePoints, AreTheSameForTheSameSeriesAndForOtherUnits) {
  const std::vector<double> times = joined(level(3, 14), level(3.2, 8));
  std::vector<double> seconds = times;
  for (double& time : seconds) time /= 1024;
  const std::vector<ChangePoint> once = change_points(times), again = change_points(times);
  ASSERT_EQ(once.size(), 1U);
  ASSERT_EQ(again.size(), 1U);
  EXPECT_EQ(once[0].first, again[0].first);
  ASSERT_EQ(change_points(seconds).size(), 1U);
  EXPECT_EQ(change_points(seconds)[0].first, once[0].first);
}

TEST(ChangePoints, NeedValuesThatDifferMoreThanOrdersDo) {
  EXPECT_THAT(change_points({}), IsEmpty());
  EXPECT_THAT(change_points(std::vector<double>{1}), IsEmpty());
  EXPECT_THAT(change_points(std::vector<double>{1, 2}), IsEmpty());
  EXPECT_THAT(change_points(std::vector<double>(30, 1.5)), IsEmpty());
  EXPECT_THAT(change_points(level(5, 40)), IsEmpty());
  // The two sides of four values have six equally likely contents.
  EXPECT_THAT(change_points(std::vector<double>{1, 1.01, 2, 2.01}), IsEmpty());
  // One commit that was disturbed.
  EXPECT_THAT(change_points(joined(joined(level(1, 20), {5}), level(1, 20))), IsEmpty());
}

TEST(ChangePoints, RefuseTimesThatNoClockGives) {
  EXPECT_THROW(change_points(std::vector<double>{1, 0, 2}), std::invalid_argument);
  EXPECT_THROW(change_points(std::vector<double>{1, std::numeric_limits<double>::quiet_NaN()}),
               std::invalid_argument);
}

/// What the rates of docs/ci.md are of: series made of recorded samples, one time per commit.
class ChangePointRates : public testing::Test {
 protected:
  static constexpr std::size_t before = 30;

  explicit ChangePointRates() {
    for (const char* folder : {"granite-rapids", "zen5"})
      recorded.push_back(read_results(source_file(std::string("results/table1/") + folder)));
  }

  /// Times of that many commits: of a random row, each the median of as many samples as the row has, drawn
  /// with replacement. From `before` on they are longer by `change`, for `changed` commits.
  std::vector<double> series(const std::vector<ResultRow>& rows, std::size_t commits, double change,
                             std::size_t changed) {
    const std::vector<double>& samples = rows[random() % rows.size()].samples_ms;
    std::vector<double> times, drawn(samples.size());
    for (std::size_t commit = 0; commit < commits; ++commit) {
      for (double& sample : drawn) sample = samples[random() % samples.size()];
      const bool is_changed = commit >= before && commit < before + changed;
      times.push_back(median(drawn) * (is_changed ? 1 + change : 1));
    }
    return times;
  }

  /// How many of `count` series are wanted.
  template <class Wanted>
  int count_of(int count, const std::vector<ResultRow>& rows, std::size_t commits, double change,
               Wanted wanted, std::size_t changed = 1000) {
    int found = 0;
    for (int i = 0; i < count; ++i) found += wanted(series(rows, commits, change, changed)) ? 1 : 0;
    return found;
  }

  static bool has_change(std::span<const double> times) { return !change_points(times).empty(); }

  /// Whether a slowdown is found within two commits of its place.
  static bool finds_it(std::span<const double> times) {
    return std::ranges::any_of(change_points(times), [](const ChangePoint& change) {
      return change.ratio.ratio > 1 && change.first >= before - 2 && change.first <= before + 2;
    });
  }

  static std::string percent(int found, int count) { return fmt::format("{:.1f} %", 100. * found / count); }

  std::mt19937_64 random{1};
  std::vector<std::vector<ResultRow>> recorded;
};

TEST_F(ChangePointRates, AreAtMostTheStatedErrorWithoutAChangeAndThoseOfTheDocumentation) {
  constexpr int unchanged = 2000, planted = 200;
  std::string table =
      "| slowdown after 30 commits | commits after it | found, Granite Rapids | found, Zen 5 "
      "|\n|---|---:|---:|---:|\n";
  table += "| none: false alarms | 10 |";
  for (const std::vector<ResultRow>& rows : recorded) {
    const int alarms = count_of(unchanged, rows, before + 10, 0, has_change);
    // Three standard deviations of a binomial count above its mean.
    EXPECT_LE(alarms, unchanged * change_error + 3 * std::sqrt(unchanged * change_error));
    table += fmt::format(" {} |", percent(alarms, unchanged));
  }
  table += "\n| none: an alarm after any commit from the 6th to the 40th | |";
  for (const std::vector<ResultRow>& rows : recorded) {
    const int alarms = count_of(planted, rows, before + 10, 0, [](std::span<const double> times) {
      for (std::size_t commits = 6; commits <= times.size(); ++commits)
        if (has_change(times.first(commits))) return true;
      return false;
    });
    table += fmt::format(" {} |", percent(alarms, planted));
  }
  table += '\n';
  for (const double change : {0.03, 0.05, 0.1})
    for (const std::size_t after : {3UL, 5UL, 10UL}) {
      table += fmt::format("| {:.0f} % | {} |", 100 * change, after);
      for (const std::vector<ResultRow>& rows : recorded)
        table +=
            fmt::format(" {} |", percent(count_of(planted, rows, before + after, change, finds_it), planted));
      table += '\n';
    }
  for (const std::size_t changed : {5UL, 10UL}) {
    table += fmt::format("| 10 % for {} commits, then as before | {} |", changed, changed + 10);
    for (const std::vector<ResultRow>& rows : recorded) {
      const std::size_t commits = before + changed + 10;
      table +=
          fmt::format(" {} |", percent(count_of(planted, rows, commits, 0.1, finds_it, changed), planted));
    }
    table += '\n';
  }
  std::cout << table;
  EXPECT_THAT(read_file(source_file("docs/ci.md")), HasSubstr(table));
}

}  // namespace
}  // namespace mssim
