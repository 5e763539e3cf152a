#include "bench/results/history.h"

#include <span>

#include "output/folders/history_file.h"
#include "output/tables/results.h"
#include "platform/files.h"
#include "scene/fields/fields.h"
#include "tests/support/files_fixture.h"
#include "tests/support/result_fixture.h"
#include "tests/support/testing.h"
#include "text/error.h"

namespace mssim {
namespace {

constexpr std::size_t recent = 10;

/// An entry of two rows; `openmp` takes that long, or was not verified.
HistoryEntry entry(int number, std::optional<double> openmp_ms, int threads = 2) {
  Provenance provenance = made_up_provenance();
  provenance.threads = threads;
  const std::vector<ResultRow> rows{
      measured_row("serial", 1 + 0.001 * (number % 3), 1.0),
      openmp_ms ? measured_row("openmp", *openmp_ms, 2.0) : failed_row("openmp", "failed: step 7")};
  return entry_of(provenance, rows, fmt::format("commit-{}", number));
}

/// Commits of a first level and of a second one, which is `ratio` times as long.
std::vector<HistoryEntry> two_levels(int first, int second, double ratio) {
  std::vector<HistoryEntry> history;
  for (int i = 0; i < first + second; ++i)
    history.push_back(entry(i, (0.5 + 0.0005 * (i % 5)) * (i < first ? 1 : ratio)));
  return history;
}

TEST(History, NamesTheCommitOfASlowdown) {
  const std::vector<HistoryEntry> history = two_levels(12, 6, 1.08);
  const std::vector<MachineHistory> machines = machines_of(history);
  ASSERT_EQ(machines.size(), 1U);
  ASSERT_EQ(machines[0].series.size(), 2U);
  EXPECT_THAT(machines[0].series[0].changes, IsEmpty());
  EXPECT_THAT(regressions(machines[0], threshold, recent),
              ElementsAre(AllOf(HasSubstr("openmp"), HasSubstr("commit-12"), HasSubstr("slower"))));
  EXPECT_THAT(regressions(machines[0], 0.1, recent), IsEmpty()) << "below the threshold";
  EXPECT_THAT(regressions(machines[0], threshold, 5), IsEmpty()) << "six commits ago";
  EXPECT_THAT(regressions(machines[0], threshold, 6), testing::SizeIs(1));
}

TEST(History, AcceptsProgressAndARepairedSlowdown) {
  std::vector<HistoryEntry> history = two_levels(12, 8, 0.8);
  EXPECT_THAT(regressions(machines_of(history)[0], threshold, recent), IsEmpty());
  history = two_levels(14, 14, 1.2);
  for (int i = 28; i < 33; ++i) history.push_back(entry(i, 0.5 + 0.0005 * (i % 5)));
  const std::vector<MachineHistory> machines = machines_of(history);
  EXPECT_EQ(machines[0].series[1].changes.size(), 2U);
  EXPECT_THAT(regressions(machines[0], threshold, history.size()), IsEmpty());
}

/// A machine whose openmp had these levels, of six commits each, whatever changes are found in them.
MachineHistory with_levels(std::vector<HistoryEntry>& history, const std::vector<double>& levels) {
  history.clear();
  for (const double ms : levels)
    for (int i = 0; i < 6; ++i)
      history.push_back(entry(static_cast<int>(history.size()), ms * (1 + 0.001 * i)));
  MachineHistory machine = machines_of(history)[0];
  HistorySeries& series = machine.series[1];
  series.changes.clear();
  for (std::size_t level = 1; level < levels.size(); ++level) series.changes.push_back({6 * level, {}});
  return machine;
}

TEST(History, AddsUpSlowdownsThatAreEachBelowTheThreshold) {
  std::vector<HistoryEntry> history;
  const MachineHistory machine = with_levels(history, {0.5, 0.515, 0.53, 0.546, 0.563});
  EXPECT_THAT(regressions(machine, threshold, 24),
              ElementsAre(HasSubstr("slower since commit commit-6, 1.13 times the time (1.1")));
  EXPECT_THAT(regressions(machine, threshold, 12), ElementsAre(HasSubstr("since commit commit-18, 1.06")));
  EXPECT_THAT(regressions(machine, threshold, 6), IsEmpty()) << "only the last step of 3 % is recent";
  EXPECT_THAT(regressions(machine, threshold, 5), IsEmpty()) << "no change is recent";
}

TEST(History, SeesASlowdownBeforeASmallChange) {
  std::vector<HistoryEntry> history;
  EXPECT_THAT(regressions(with_levels(history, {0.5, 0.6, 0.605}), threshold, 12),
              ElementsAre(HasSubstr("slower since commit commit-6, 1.21 times")));
  EXPECT_THAT(regressions(with_levels(history, {0.6, 0.5, 0.55}), threshold, 12),
              ElementsAre(HasSubstr("slower since commit commit-12, 1.1 times")));
}

std::string cell_of(const Table& table, std::size_t row, std::string_view column) {
  const auto found = std::ranges::find(table.columns, column, &Column::name);
  return cell_text(table.rows[row][static_cast<std::size_t>(found - table.columns.begin())], *found);
}

TEST(History, TellsNoIntervalOfTooFewTimes) {
  std::vector<HistoryEntry> history;
  MachineHistory machine = with_levels(history, {0.5, 0.6});
  HistorySeries& series = machine.series[1];
  series.changes = {{11, ratio_of(std::span(series.ms).first(11), std::span(series.ms).last(1))}};
  ASSERT_FALSE(series.changes[0].ratio.covers);
  EXPECT_THAT(
      regressions(machine, threshold, recent),
      ElementsAre(AllOf(HasSubstr("slower since commit commit-11"), testing::Not(HasSubstr(" to ")))));
  EXPECT_EQ(cell_of(history_table(machine, threshold), 2, "low"), "–");
  EXPECT_EQ(series.low, series.ms) << "entries of three samples";
  history[0].rows[1].samples = 6;
  EXPECT_EQ(machines_of(history)[0].series[1].low[0], 0.25);
}

TEST(History, MissesARowThatIsNoLongerVerifiedOrMeasured) {
  std::vector<HistoryEntry> history = two_levels(5, 0, 1);
  history.push_back(entry(5, std::nullopt));
  history.push_back(entry(6, std::nullopt));
  EXPECT_THAT(regressions(machines_of(history)[0], threshold, recent),
              ElementsAre(AllOf(HasSubstr("openmp"), HasSubstr("commit-5"))));
  EXPECT_THAT(regressions(machines_of(history)[0], threshold, 1), IsEmpty());
  history.back().rows.clear();
  EXPECT_THAT(regressions(machines_of(history)[0], threshold, recent), testing::SizeIs(2));
  history.push_back(entry(7, 0.5));
  EXPECT_THAT(regressions(machines_of(history)[0], threshold, recent), IsEmpty()) << "both are back";
}

TEST(History, NeverComparesMachinesDevicesOrSizes) {
  std::vector<HistoryEntry> history = two_levels(10, 0, 1);
  for (int i = 0; i < 10; ++i) history.push_back(entry(i, 5 + 0.005 * (i % 5), 1));
  std::vector<MachineHistory> machines = machines_of(history);
  ASSERT_EQ(machines.size(), 2U);
  for (const MachineHistory& machine : machines) {
    EXPECT_THAT(machine.entries, testing::SizeIs(10));
    for (const HistorySeries& series : machine.series) EXPECT_THAT(series.changes, IsEmpty());
  }
  history[9].rows[0].device = "cpu avx512";
  history[9].rows[1].nodes = 2501;
  machines = machines_of(history);
  EXPECT_THAT(machines[0].series, testing::SizeIs(4));
  EXPECT_THAT(regressions(machines[0], threshold, recent),
              testing::ElementsAre(HasSubstr("another device"), HasSubstr("other nodes")))
      << "the former rows vanished";
}

TEST(History, HasOneEntryOfACommitAndMachine) {
  std::vector<HistoryEntry> history{entry(1, 0.5)};
  EXPECT_THAT([&] { add_entry(history, entry(1, 0.7), false); },
              testing::ThrowsMessage<UsageError>(AllOf(HasSubstr("commit-1"), HasSubstr("--replace"))));
  add_entry(history, entry(1, 0.7), true);
  ASSERT_EQ(history.size(), 1U);
  EXPECT_EQ(history[0].rows[1].ms_per_step, 0.7);
  add_entry(history, entry(1, 0.9, 1), false);
  add_entry(history, entry(2, 0.9), false);
  EXPECT_EQ(history.size(), 3U);
}

TEST(History, TakesTheCommitOfTheProgramUnlessOneIsGiven) {
  Provenance provenance = made_up_provenance();
  const std::vector<ResultRow> rows{measured_row("serial", 1, 1.0)};
  EXPECT_EQ(entry_of(provenance, rows).commit, provenance.build.commit + ", changed");
  EXPECT_EQ(entry_of(provenance, rows, "mine").commit, "mine");
  EXPECT_THROW(entry_of(provenance, {}), UsageError);
  provenance.build.commit = "unknown";
  EXPECT_THAT([&] { entry_of(provenance, rows); }, testing::ThrowsMessage<UsageError>(HasSubstr("--commit")));
}

TEST(History, ShowsEachLevelAndWhatVanished) {
  std::vector<HistoryEntry> history = two_levels(12, 6, 1.08);
  history.push_back(entry(18, std::nullopt));
  history.back().commit = "0123456789abcdef0123456789abcdef01234567, changed";
  const Table table = history_table(machines_of(history)[0], threshold);
  ASSERT_EQ(table.rows.size(), 4U);
  const auto cell = [&](std::size_t row, std::string_view column) { return cell_of(table, row, column); };
  EXPECT_EQ(cell(0, "verdict"), "–");
  EXPECT_EQ(cell(1, "commits"), "12");
  EXPECT_EQ(cell(2, "since"), "commit-12");
  EXPECT_EQ(cell(2, "verdict"), "slower");
  EXPECT_EQ(cell(3, "since"), "0123456789ab, changed");
  EXPECT_EQ(cell(3, "verdict"), "vanished");
}

TEST(History, ShowsByWhatSeriesOfACombinationDiffer) {
  std::vector<HistoryEntry> history = two_levels(3, 0, 1);
  history[1].rows[1].device = "pthread-haswell-A Processor";
  history[2].rows[1].device = "pthread-znver4-A Processor";
  history[2].rows[1].nodes = 2501;
  EXPECT_THAT(to_text(history_table(machines_of(history)[0], threshold), ListingFormat::csv),
              AllOf(HasSubstr("openmp,semi-euler,cpu,2500,commit-0,"),
                    HasSubstr("openmp,semi-euler,pthread-haswell-A Processor,2500,commit-1,"),
                    HasSubstr("openmp,semi-euler,pthread-znver4-A Processor,2501,commit-2,")));
}

class HistoryFile : public TemporaryFolderTest {
 protected:
  /// The sentence that refuses the text.
  static std::string refusal(const std::string& text) {
    return sentence_of<Error>([&] { parse_history("h.jsonl", text); });
  }
};

TEST_F(HistoryFile, ReadsBackWhatWasWritten) {
  std::vector<HistoryEntry> history = two_levels(3, 0, 1);
  history.push_back(entry(3, std::nullopt));
  history[1].rows[0].device = std::string(300, 'd') + '\n';
  history[1].rows[1].integrator = "\xff";
  for (std::size_t row = 0; row < 2; ++row) {  // is cut at a character, not at a byte
    history[2].rows[row].device.assign(row, 'd');
    for (int i = 0; i < 150; ++i) history[2].rows[row].device += "\u00e9";
  }
  change_history(folder() / "h.jsonl", [&](std::vector<HistoryEntry>& entries) { entries = history; });
  const std::vector<HistoryEntry> read = read_history(folder() / "h.jsonl");
  ASSERT_EQ(read.size(), history.size());
  for (std::size_t i = 0; i < read.size(); ++i) EXPECT_EQ(history_line(read[i]), history_line(history[i]));
  EXPECT_EQ(read[0].rows[1].ms_per_step, history[0].rows[1].ms_per_step);
  EXPECT_FALSE(read[3].rows[1].verified);
  EXPECT_FALSE(read[3].rows[1].ms_per_step);
  // One that is changed by two at once would lose what one of them adds.
  EXPECT_THROW(change_history(folder() / "h.jsonl",
                              [&](auto&) { change_history(folder() / "h.jsonl", [](auto&) {}); }),
               WriteError);
  EXPECT_EQ(read_history(folder() / "h.jsonl").size(), history.size());
}

TEST_F(HistoryFile, NamesTheLineThatIsWrong) {
  const std::string line = history_line(entry(1, 0.5));
  EXPECT_EQ(refusal(line + "\r\n\n" + history_line(entry(2, 0.5))), "");
  EXPECT_THAT(refusal(line + "\r\n\n" + line), AllOf(HasSubstr("h.jsonl, line 3"), HasSubstr("commit-1")));
  EXPECT_THAT(refusal(line + '\n' + line.substr(0, 100) + '\n'), HasSubstr("h.jsonl, line 2"));
  EXPECT_THAT(refusal("\n\n" + with_change(line, "\"threads\":2", "\"threads\":-2")),
              AllOf(HasSubstr("h.jsonl, line 3"), HasSubstr("/threads"), HasSubstr("-2")));
  EXPECT_THAT(refusal(with_change(line, "\"ms_per_step\":0.5,", "\"ms_per_step\":0,")),
              AllOf(HasSubstr("line 1"), HasSubstr("/rows/1/ms_per_step")));
  EXPECT_THAT(refusal(with_change(line, "\"ms_per_step\":0.5,", "\"ms_per_step\":1e-300,")),
              HasSubstr("/rows/1/ms_per_step"));
  HistoryEntry twice = entry(1, 0.5);
  twice.rows.push_back(twice.rows[1]);
  EXPECT_THAT(refusal(line + '\n' + with_change(history_line(twice), "commit-1", "commit-2")),
              AllOf(HasSubstr("line 2: /rows/2 has cloth2500, openmp, semi-euler"), HasSubstr("remove")));
  EXPECT_THAT(refusal(with_change(line, "\"schema_version\":1", "\"schema_version\":2,\"new\":3")),
              AllOf(HasSubstr("line 1"), HasSubstr("/schema_version is 2"), HasSubstr("version 1")));
  EXPECT_THAT(refusal("{}"), AllOf(HasSubstr("line 1"), HasSubstr("/schema_version")));
}

}  // namespace
}  // namespace mssim
