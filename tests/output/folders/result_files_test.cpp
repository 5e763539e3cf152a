#include <fstream>
#include <nlohmann/json.hpp>

#include "output/folders/provenance_file.h"
#include "output/folders/result_folder.h"
#include "output/tables/results.h"
#include "output/tables/suite_tables.h"
#include "output/tables/table.h"
#include "platform/files.h"
#include "tests/support/files_fixture.h"
#include "tests/support/result_fixture.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

namespace fs = std::filesystem;
using testing::Lt;

class ResultFiles : public TemporaryFolderTest {
 protected:
  static ResultFolder results_in(const fs::path& where, Provenance provenance = made_up_provenance()) {
    return {where, std::move(provenance), paper_tables(legend, published_tables())};
  }
  std::vector<ResultRow> read_back(const std::string& timings) const {
    return read_timings(CsvTable(put("timings.csv", timings)));
  }

  std::vector<ResultRow> rows{measured_row("serial", 0.5, 1.0)};
};

TEST_F(ResultFiles, TimingsHaveAColumnForEachNumberAndQuoteWhatNeedsIt) {
  rows = {measured_row("serial", 0.125, 1.0),
          failed_row("opencl", "unavailable: no device \"fast, big\"\nhere")};
  EXPECT_THAT(
      timings_csv(rows),
      AllOf(HasSubstr("\ncloth2500,2500,14502,29004,serial,cpu,2,semi-euler,5e-04,3,0.125,0.0625,0.25,0.0625,"
                      "116016000,1.5,0.25,1,19.475,1e-05,-2e-07,true,ok,,4,0,0123456789abcdef,1.5,0.0625,"
                      "0.03125,6000,0.5,1.25,8"),
            HasSubstr("\ncloth2500,2500,14502,29004,opencl,cpu,2,semi-euler,5e-04,0,,,,,,,,,,,,false,"
                      "\"unavailable: no device \"\"fast, big\"\"\nhere\",,4,0,,,,,,,,")));
}

TEST(ResultColumns, AreWhereTheyWere) {
  const CsvTable earlier(source_file("results/cluster/zen4/timings.csv"));
  const std::vector<std::string_view> known(earlier.header().begin(), earlier.header().end());
  EXPECT_NO_THROW(CsvTable("timings.csv", timings_csv({})).require_columns(known));
}

TEST_F(ResultFiles, TimingsAndSamplesComeBackAsTheyWere) {
  rows = {measured_row("serial", 1.0 / 3, 1.0), measured_row("openmp", 0.1, M_PI),
          failed_row("opencl", "failed: \"x\", at\r\nstep 3")};
  rows[1].samples_ms = {0.1, 1.0 / 7, std::numeric_limits<double>::denorm_min()};
  results_in(folder()).write(rows);
  const std::vector<ResultRow> back = read_results(folder());
  ASSERT_EQ(back.size(), rows.size());
  EXPECT_EQ(timings_csv(back), timings_csv(rows));
  EXPECT_EQ(samples_csv(back), samples_csv(rows));
  EXPECT_EQ(back[0].ms_per_step, 1.0 / 3);
  EXPECT_EQ(back[1].speedup_vs_serial, M_PI);
  EXPECT_EQ(back[1].samples_ms, rows[1].samples_ms);
  EXPECT_EQ(back[1].sample_steps, rows[1].sample_steps);
  EXPECT_TRUE(back[1].verified);
  EXPECT_EQ(back[2].status, rows[2].status);
  EXPECT_EQ(back[2].ms_per_step, std::nullopt);
}

TEST_F(ResultFiles, LeaveOutARoundThatOnlyTheSamplesHave) {
  results_in(folder()).write(rows);
  const std::vector<double> before = rows[0].samples_ms;
  rows[0].samples_ms.push_back(7);
  rows[0].sample_steps.push_back(10);
  std::ofstream(folder() / "samples.csv") << samples_csv(rows);  // ended before the other files
  const std::vector<ResultRow> back = read_results(folder());
  EXPECT_EQ(back.at(0).samples_ms, before);
  EXPECT_EQ(back.at(0).sample_steps.size(), before.size());
}

TEST_F(ResultFiles, GoOnUnderTheProvenanceOfTheRunThatAddsRows) {
  const std::string file = (folder() / "provenance.json").string();
  results_in(folder()).begin();
  Provenance later = made_up_provenance();
  later.started_utc = "2030-01-01T00:00:00Z";
  ResultFolder results = results_in(folder(), later);
  results.go_on_with(made_up_provenance());
  results.begin();
  EXPECT_THAT(read_file(file), Not(HasSubstr("2030"))) << "nothing of it is measured yet";
  results.write(rows);
  EXPECT_THAT(read_file(file), AllOf(HasSubstr("2030"), HasSubstr(made_up_provenance().started_utc)));
}

TEST_F(ResultFiles, RenewTheFileForGithub) {
  const fs::path file = folder() / "github.json";
  {
    ResultFolder results = results_in(folder());
    results.write(rows);
    EXPECT_FALSE(fs::exists(file)) << "nobody asked for it";
    results.write_for_github(rows);
  }
  {
    ResultFolder results = results_in(folder());
    results.go_on_with(made_up_provenance());
    rows[0].ms_per_step = 0.25;
    results.write(rows);
    EXPECT_EQ(read_file(file), to_text(github_table(rows), ListingFormat::json));
  }
  ResultFolder results = results_in(folder());
  results.replace_results();
  results.write(rows);
  EXPECT_FALSE(fs::exists(file));
}

TEST_F(ResultFiles, AreThereIfAnyFileHasTheNameOfOne) {
  const std::vector<std::string> names{"timings.csv", "samples.csv",     "garment.csv", "benchmark.json",
                                       "github.json", "table1.md",       "guide.csv",   "provenance.json",
                                       "threads.md",  "guide-errors.csv"};
  for (const std::string& name : names) {
    EXPECT_FALSE(results_in(folder()).has_results());
    put(name, "mine");
    EXPECT_TRUE(results_in(folder()).has_results()) << name;
    fs::remove(folder() / name);
  }
  results_in(folder()).begin();
  EXPECT_FALSE(results_in(folder()).has_results()) << "a run was ended before its first row";
}

TEST_F(ResultFiles, LeaveWhatNoEarlierRunWroteInTheirPlace) {
  const std::string stem = file_stems(rows).front();
  const auto refused = [&](bool with_traces) {
    const ResultFolder results = results_in(folder());
    return sentence_of<UsageError>([&] { results.require_free(rows, with_traces); });
  };
  results_in(folder()).require_free(rows, true);
  results_in(folder()).begin();
  results_in(folder()).write(rows);  // without --trace, and of no program
  for (const std::string& name : {"traces/" + stem + ".h5", "programs/" + stem + ".txt"}) {
    put(name, "mine");
    EXPECT_THAT(refused(true), AllOf(HasSubstr(name + " is not of an earlier run"), HasSubstr("move it")));
    ResultFolder results = results_in(folder());
    if (name.starts_with("traces")) results.require_free(rows, false);
    results.replace_results();
    results.write(rows);
    EXPECT_EQ(read_file(folder() / name), "mine");
    fs::remove_all((folder() / name).parent_path());
  }
  fs::create_directory_symlink(folder(), folder() / "traces");
  EXPECT_THAT(refused(true), HasSubstr("traces is a link"));
}

TEST_F(ResultFiles, ThatAreReplacedTakeTheirTracesAlong) {
  const std::string stem = "traces/" + file_stems(rows).front();
  Provenance traced = made_up_provenance();
  traced.command_line.emplace_back("--trace");
  results_in(folder(), traced).begin();
  results_in(folder(), traced).write(rows);
  for (const char* end : {".h5", ".xdmf", ".h5.part", ".xdmf.part", "-mine.h5"}) put(stem + end, "old");
  ResultFolder results = results_in(folder());
  results.replace_results();
  results.begin();
  EXPECT_TRUE(fs::exists(folder() / (stem + ".h5"))) << "nothing new is measured yet";
  results.write(rows);
  EXPECT_EQ(read_file(folder() / (stem + "-mine.h5")), "old") << "it is the user's";
  EXPECT_EQ(std::distance(fs::directory_iterator(folder() / "traces"), {}), 1);
}

TEST_F(ResultFiles, SamplesAreListedRoundByRound) {
  EXPECT_EQ(samples_csv(rows),
            "scene,backend,integrator,round,steps,ms_per_step,outlier\n"
            "cloth2500,serial,semi-euler,1,10,1,\n"
            "cloth2500,serial,semi-euler,2,20,0.25,\n"
            "cloth2500,serial,semi-euler,3,30,0.5,\n");
  ResultRow row = measured_row("serial", 0.5, 1.0);
  row.samples_ms = {1, 1, 1.125, 1.25, 1.25, 1.75, 1, 9};
  row.sample_steps.assign(8, 7);
  const std::string text = samples_csv(std::vector{row});
  EXPECT_THAT(text, HasSubstr(",5,7,1.25,\n"));
  EXPECT_THAT(text, HasSubstr(",8,7,9,extreme\n"));
}

TEST_F(ResultFiles, TimingsAllowFurtherColumnsBehindTheirs) {
  std::istringstream lines(timings_csv(rows));
  std::string header, row;
  std::getline(lines, header);
  std::getline(lines, row);
  const auto back = read_back(header + ",joules\r\n" + row + ",3\r\n");
  ASSERT_EQ(back.size(), 1U);
  EXPECT_EQ(back[0].status, "ok");
}

TEST_F(ResultFiles, OfOlderProgramsAreReadToo) {
  std::istringstream lines(timings_csv(rows));
  std::string text;
  for (std::string line; std::getline(lines, line);) {
    for (std::size_t columns = 24; columns < result_columns.size(); ++columns) line.resize(line.rfind(','));
    text += line + '\n';
  }
  EXPECT_THAT(text, HasSubstr("status,note\n"));
  const auto back = read_back(text);
  ASSERT_EQ(back.size(), 1U);
  EXPECT_EQ(back[0].ms_per_step, 0.5);
  EXPECT_EQ(back[0].warm_up_trials, 0);
  EXPECT_EQ(back[0].state_hash, std::nullopt);
  EXPECT_EQ(back[0].processors_used, std::nullopt);
}

TEST_F(ResultFiles, ThatAreWrongAreRefusedWithThePlace) {
  const std::string good = timings_csv(rows);
  const auto complaint = [&](const std::string& text) -> std::string {
    return sentence_of<CsvError>([&] { read_back(text); });
  };
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    return text.replace(text.rfind(from), from.size(), to);
  };
  EXPECT_EQ(complaint(good), "");
  EXPECT_THAT(complaint(with("19.475", "fast")), HasSubstr("timings.csv, line 2, column paper_ms: \"fast\""));
  EXPECT_THAT(complaint(with("19.475", "nan")), HasSubstr("column paper_ms: \"nan\""));
  EXPECT_THAT(complaint(with("2500,14502", "-1,14502")), HasSubstr("column nodes: \"-1\""));
  EXPECT_THAT(complaint(with("true", "yes")), HasSubstr("column verified: \"yes\""));
  EXPECT_THAT(complaint(with(",ok", "")),
              HasSubstr(fmt::format("line 2: has {} fields, but the header has {}", result_columns.size() - 1,
                                    result_columns.size())));
  EXPECT_THAT(complaint(with("0123456789abcdef", "0123")),
              HasSubstr("is not a hash of 16 hexadecimal digits"));
  EXPECT_THAT(complaint(with("ok", "\"ok")), HasSubstr("line 2: a quoted field does not end"));
  EXPECT_THAT(complaint(with("roofline_fraction", "roof")), HasSubstr("column 17 is \"roof\""));
  EXPECT_THAT(complaint(""), HasSubstr("column 1 is missing"));
  EXPECT_THROW(read_timings(CsvTable(folder() / "missing.csv")), CsvError);
  EXPECT_THROW(read_timings(CsvTable(folder())), CsvError);
  // Found by fuzzing: whatever stood in the file went into the message.
  EXPECT_THAT(complaint(with("19.475", "\x1b[31m" + std::string(100'000, 'w'))),
              AllOf(HasSubstr("column paper_ms: \"\\u001b[31mwww"), SizeIs(Lt(300U))));
  EXPECT_THAT(complaint(with("roofline_fraction", "\xff\x7f" + std::string(100'000, 'w'))),
              AllOf(HasSubstr("is \"\xef\xbf\xbd\\u007fwww"), SizeIs(Lt(300U))));
}

TEST_F(ResultFiles, WithoutAnEndAreRefusedAndNotRead) {
  EXPECT_THROW(read_timings(CsvTable("/dev/zero")), CsvError);
  const fs::path huge = put("huge.csv", "");
  fs::resize_file(huge, largest_csv_bytes + 1);  // without its blocks
  EXPECT_THAT(sentence_of<CsvError>([&] { CsvTable{huge}; }), HasSubstr("is longer than 64 MiB"));
}

TEST_F(ResultFiles, SamplesOutOfOrderAreRefused) {
  rows[0].samples_ms.clear();
  rows[0].sample_steps.clear();
  const fs::path file = put("samples.csv",
                            "scene,backend,integrator,round,steps,ms_per_step\n"
                            "cloth2500,serial,semi-euler,2,10,1\n");
  EXPECT_THROW(read_samples(CsvTable(file), rows), CsvError);
}

TEST_F(ResultFiles, AreAllThereAfterEveryWriteAndJsonIsValid) {
  ResultFolder results = results_in(folder() / "new/out");
  results.begin();
  EXPECT_EQ(read_file(folder() / "new/out/provenance.json"), provenance_text(made_up_provenance()) + '\n');
  EXPECT_TRUE(read_results(folder() / "new/out").empty());
  rows.clear();
  for (const ResultRow& row : table_rows()) {
    rows.push_back(row);
    results.write(rows);
    EXPECT_EQ(read_file(folder() / "new/out/timings.csv"), timings_csv(rows));
    EXPECT_EQ(read_file(folder() / "new/out/samples.csv"), samples_csv(rows));
    EXPECT_EQ(read_file(folder() / "new/out/benchmark.json"), benchmark_json(rows, made_up_provenance()));
    const ResultTable table =
        only_table(paper_tables(legend, published_tables())(rows, made_up_provenance()), "table1");
    EXPECT_EQ(read_file(folder() / "new/out/table1.csv"), table_csv(table.data));
    EXPECT_EQ(read_file(folder() / "new/out/table1.md"), markdown(table.page));
  }
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder() / "new/out"))
    names.push_back(entry.path().filename().string());
  EXPECT_THAT(names, testing::UnorderedElementsAre("timings.csv", "samples.csv", "benchmark.json",
                                                   "provenance.json", "table1.csv", "table1.md"));
}

TEST_F(ResultFiles, StayAsTheyWereWhenANumberIsNotFinite) {
  ResultFolder results = results_in(folder());
  results.write(rows);
  const std::string before = read_file(folder() / "timings.csv") + read_file(folder() / "benchmark.json");
  rows.push_back(measured_row("openmp", 0.25, 2.0));
  rows[1].energy_drift = std::numeric_limits<double>::infinity();
  EXPECT_THROW(results.write(rows), std::invalid_argument);
  rows[1].energy_drift = 0;
  rows[1].samples_ms[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(results.write(rows), std::invalid_argument);
  EXPECT_EQ(read_file(folder() / "timings.csv") + read_file(folder() / "benchmark.json"), before);
}

TEST_F(ResultFiles, GoIntoNoFolderThatALinkLeadsTo) {
  fs::create_directory(folder() / "elsewhere");
  fs::create_directory(folder() / "out");
  fs::create_directory_symlink(folder() / "elsewhere", folder() / "out" / programs_name);
  ResultFolder results = results_in(folder() / "out");
  ResultRow program = failed_row("mine.py", "failed: out of cake");
  program.program_output = "cake";
  EXPECT_THROW(results.write(std::vector{program}), WriteError);
  EXPECT_TRUE(fs::is_empty(folder() / "elsewhere"));
}

TEST_F(ResultFiles, WithAByteOrderMarkAreReadToo) {
  const std::string mark = "\xef\xbb\xbf";
  std::vector<ResultRow> back = read_back(mark + timings_csv(rows));
  ASSERT_EQ(back.size(), 1U);
  read_samples(CsvTable(put("samples.csv", mark + samples_csv(rows))), back);
  EXPECT_EQ(back[0].samples_ms, rows[0].samples_ms);
  EXPECT_EQ(parse_provenance("p.json", mark + provenance_text(made_up_provenance())).threads, 2);
}

TEST(FileStems, AreTheNamesOfARowAndUnambiguousAndShortEnough) {
  const auto row = [](std::string scene, std::string backend) {
    ResultRow named = measured_row(backend, 1, 1.0);
    named.scene = std::move(scene);
    return named;
  };
  std::string letters;
  for (int i = 0; i < 100; ++i) letters += "\xc3\xa4";
  const std::vector<std::string> stems = file_stems(std::vector{
      row("box-small", "threads-mutex"), row("x", "y-z"), row("x-y", "z"), row(letters, letters.substr(2)),
      row(letters.substr(2), letters), row("../../etc", "serial"), row("x", "openmp:1"), row("x", "openmp_1"),
      row("x", "a|b\\c")});
  EXPECT_EQ(stems[0], "box-small-threads-mutex-semi-euler");
  EXPECT_EQ(stems[1], "x-y-z-semi-euler");
  EXPECT_THAT(stems[2], testing::MatchesRegex("x-y-z-semi-euler-[0-9a-f]{16}"));
  EXPECT_THAT(stems[5], AllOf(StartsWith(".._.._etc-"), Not(HasSubstr("/"))));
  EXPECT_EQ(stems[6], "x-openmp_1-semi-euler");
  EXPECT_THAT(stems[7], testing::MatchesRegex("x-openmp_1-semi-euler-[0-9a-f]{16}"));
  EXPECT_EQ(stems[8], "x-a_b_c-semi-euler");
  EXPECT_EQ(std::set<std::string>(stems.begin(), stems.end()).size(), stems.size());
  for (const std::string& stem : stems) {
    EXPECT_LE(stem.size(), 240U);
    EXPECT_NO_THROW(nlohmann::json(stem).dump()) << "a letter is cut";
  }
}

}  // namespace
}  // namespace mssim
