#include "output/tables/suite_tables.h"

#include "output/tables/table.h"
#include "tests/support/result_fixture.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

std::vector<ResultRow> peer_rows() {
  std::vector<ResultRow> rows{
      in_six_rounds(measured_row("serial", 1, 1.0)), in_six_rounds(measured_row("openmp", 0.125, 8.0)),
      in_six_rounds(measured_row("numba", 0.5, 2.0)), failed_row("jax", "unavailable: no module | jax")};
  rows[0].threads = 1;
  rows[2].note = "Numba 1.2; gather";
  return rows;
}

ResultTable peer_table_of(const std::vector<ResultRow>& rows) {
  return only_table(peer_tables()(rows, made_up_provenance()), "peers");
}

TEST(PeerTable, AsCsvHasTheRatioToOpenmpWithItsInterval) {
  std::vector<ResultRow> rows = peer_rows();
  rows[2].samples_ms = {0.5, 0.25, 0.125, 0.5, 0.25, 0.125};  // of openmp's 0.25, 0.0625, 0.125
  EXPECT_EQ(
      table_csv(peer_table_of(rows).data),
      "scene,nodes,integrator,peer,threads,processors_used,ms_per_step,ms_per_step_low,ms_per_step_high,"
      "times_openmp,times_openmp_low,times_openmp_high,position_error,verified,status,note\n"
      "cloth2500,2500,semi-euler,serial,1,1.5,1,0.5,2,8,8,8,1e-05,true,ok,\n"
      "cloth2500,2500,semi-euler,openmp,2,1.5,0.125,0.0625,0.25,1,1,1,1e-05,true,ok,\n"
      "cloth2500,2500,semi-euler,numba,2,1.5,0.5,0.25,1,2,1,4,1e-05,true,ok,Numba 1.2; gather\n"
      "cloth2500,2500,semi-euler,jax,2,,,,,,,,,false,unavailable: no module | jax,\n");
}

TEST(PeerTable, AsMarkdownHasABlockASceneAndWhatTheySayOfThemselves) {
  const std::string page = markdown(peer_table_of(peer_rows()).page);
  EXPECT_THAT(page, HasSubstr("| `numba` | 2 | 1.50 | **0.500** | 4.00× | 4.00 to 4.00 | "));
  EXPECT_THAT(page, HasSubstr("| `jax` | – | – | unavailable | – | – | – |\n"));
  EXPECT_THAT(page, HasSubstr("- `numba`: Numba 1.2; gather\n"));
  EXPECT_THAT(page, HasSubstr("- `jax`, `semi-euler`: unavailable: no module \\| jax"));
}

TEST(PeerTable, HasNoIntervalOfTooFewRounds) {
  std::vector<ResultRow> rows = peer_rows();
  for (ResultRow& row : rows)
    if (!row.samples_ms.empty()) row.samples_ms.pop_back();
  EXPECT_THAT(markdown(peer_table_of(rows).page), HasSubstr("| **0.500** | 4.00× | – | "));
  EXPECT_THAT(table_csv(peer_table_of(rows).data), HasSubstr("numba,2,1.5,0.5,0.25,1,4,,,1e-05"));
}

TEST(PeerTable, HasNoRatioWithoutOpenmp) {
  std::vector<ResultRow> rows = peer_rows();
  rows[1].verified = false;
  EXPECT_THAT(markdown(peer_table_of(rows).page), HasSubstr("| `numba` | 2 | 1.50 | **0.500** | – | – | "));
  rows = peer_rows();
  rows[2].samples_ms.pop_back();
  EXPECT_THAT(table_csv(peer_table_of(rows).data), HasSubstr("numba,2,1.5,0.5,0.25,1,,,,1e-05"));
}

TEST(PeerTable, ShowsNoTimeThatWasNotVerified) {
  std::vector<ResultRow> rows = peer_rows();
  rows[2].verified = false;
  const ResultTable table = peer_table_of(rows);
  EXPECT_THAT(markdown(table.page), HasSubstr("| `numba` | – | – | failed | – | – | – |"));
  EXPECT_THAT(table_csv(table.data), HasSubstr("false,failed: not verified"));
}

std::vector<ResultRow> rows_by_threads() {
  std::vector<ResultRow> rows{
      in_six_rounds(measured_row("serial", 4, 1.0)), in_six_rounds(measured_row("openmp:1", 1, 4.0)),
      failed_row("opencl:1", "failed: step 3"), in_six_rounds(measured_row("openmp", 0.625, 6.4)),
      in_six_rounds(measured_row("opencl", 0.5, 8.0))};
  rows[1].threads = 1;
  return rows;
}

ResultTable thread_table_of(const std::vector<ResultRow>& rows,
                            const Provenance& provenance = made_up_provenance()) {
  return only_table(
      with_thread_table([](auto, const auto&) { return std::vector<ResultTable>(); })(rows, provenance),
      "threads");
}

TEST(ThreadTable, AsCsvHasSpeedUpsOverTheFewestThreadsAndEfficiencies) {
  EXPECT_EQ(table_csv(thread_table_of(rows_by_threads()).data),
            "scene,nodes,integrator,backend,threads,processors_used,ms_per_step,ms_per_step_low,"
            "ms_per_step_high,speedup,speedup_low,speedup_high,efficiency,status\n"
            "cloth2500,2500,semi-euler,openmp,1,1.5,1,0.5,2,1,1,1,1,ok\n"
            "cloth2500,2500,semi-euler,opencl,1,,,,,,,,,failed: step 3\n"
            "cloth2500,2500,semi-euler,openmp,2,1.5,0.625,0.3125,1.25,1.6,1.6,1.6,0.8,ok\n"
            "cloth2500,2500,semi-euler,opencl,2,1.5,0.5,0.25,1,,,,,ok\n");
}

TEST(ThreadTable, AsMarkdownNamesBackendsWithoutTheirThreads) {
  const std::string page = markdown(thread_table_of(rows_by_threads()).page);
  EXPECT_THAT(page, HasSubstr("| `openmp` | 2 | **0.625** | 1.60× | 1.60 to 1.60 | 0.800 | 1.50 |\n"));
  EXPECT_THAT(page, HasSubstr("| `opencl` | 2 | **0.500** | – | – | – | 1.50 |\n"));
  EXPECT_THAT(page, Not(HasSubstr("serial")));
}

TEST(ThreadTable, MarksARatioThatItsTimesContradict) {
  std::vector<ResultRow> rows = rows_by_threads();
  EXPECT_THAT(markdown(thread_table_of(rows).page), Not(HasSubstr("†")));
  rows[3].ms_per_step = 1.01;
  EXPECT_THAT(markdown(thread_table_of(rows).page),
              AllOf(HasSubstr("| `openmp` | 2 | **1.01** | 1.60×† | "), HasSubstr("|\n\n† ")));
}

TEST(ThreadTable, HasEfficienciesOverTheFewestThreadsThatAreSeveral) {
  Provenance provenance = made_up_provenance();
  provenance.threads = 8;
  std::vector<ResultRow> rows{measured_row("openmp:2", 1, 1.0), measured_row("openmp", 0.4, 2.5)};
  rows[1].threads = 8;
  EXPECT_THAT(table_csv(thread_table_of(rows, provenance).data),
              HasSubstr(",8,1.5,0.4,0.2,0.8,2.5,,,0.625,ok\n"))
      << "three rounds have no interval";
}

/// Rows of `openmp` on a cloth so narrow that at most two threads compute its steps, of a run on 16.
std::vector<ResultRow> rows_of_narrow_cloth() {
  std::vector<ResultRow> rows{measured_row("openmp:1", 1, 1.0), measured_row("openmp:2", 0.625, 1.6),
                              measured_row("openmp:8", 0.5, 2.0), measured_row("openmp", 0.5, 2.0)};
  rows[0].threads = 1;
  return rows;
}

TEST(ThreadTable, HasTheThreadsThatComputedIfTheyAreFewerThanRequested) {
  Provenance provenance = made_up_provenance();
  provenance.threads = 16;
  std::vector<ResultRow> rows = rows_of_narrow_cloth();
  rows.erase(rows.begin() + 1, rows.begin() + 3);
  const ResultTable table = thread_table_of(rows, provenance);
  // Twice as fast on two threads as on one; on 16 that would be an efficiency of 0.125.
  EXPECT_THAT(table_csv(table.data), HasSubstr("openmp,2,1.5,0.5,0.25,1,2,,,1,ok\n"));
  EXPECT_THAT(markdown(table.page), AllOf(HasSubstr("| `openmp` | 2 | **0.500** | 2.00× | – | 1.00 |"),
                                          HasSubstr("may be fewer than requested")));
  rows[1].threads = 17;
  EXPECT_THAT(markdown(thread_table_of(rows, provenance).page),
              HasSubstr("| `openmp` | 16 | **0.500** (!) |"));
}

TEST(ThreadTable, ShowsEachNumberOfThreadsOnce) {
  Provenance provenance = made_up_provenance();
  provenance.threads = 16;
  std::vector<ResultRow> rows = rows_of_narrow_cloth();
  const std::string page = markdown(thread_table_of(rows, provenance).page);
  EXPECT_THAT(page, HasSubstr("| `openmp` | 2 | **0.625** | 1.60× | – | 0.800 |"));
  EXPECT_THAT(page, Not(HasSubstr("**0.500**"))) << "two threads as well, however many were requested";
  rows[1] = failed_row("openmp:2", "failed: step 3");
  EXPECT_THAT(table_csv(thread_table_of(rows, provenance).data),
              AllOf(HasSubstr("openmp,2,,,,,,,,,failed: step 3\n"), HasSubstr("openmp,2,1.5,0.5,")))
      << "a failure hides no time";
  rows.erase(rows.begin(), rows.begin() + 2);
  EXPECT_THAT(with_thread_table(race_tables({}))(rows, provenance), IsEmpty()) << "one number of threads";
}

TEST(ThreadTable, LeavesOutMoreThreadsThanTheRunHas) {
  const auto maker = with_thread_table(peer_tables());
  std::vector<ResultRow> rows{measured_row("threads-mutex", 1, 1.0),
                              measured_row("threads-mutex:10", 2, 0.5)};
  rows[0].threads = 16;
  rows[1].threads = 10;
  Provenance provenance = made_up_provenance();
  EXPECT_EQ(maker(rows, provenance).size(), 1U);
  provenance.threads = 16;
  EXPECT_EQ(maker(rows, provenance).size(), 2U);
  EXPECT_EQ(maker(peer_rows(), provenance).size(), 1U) << "one number of threads";
}

const std::vector<RaceLegend> race_methods{{"serial", "one thread", "none", "once", "yes"},
                                           {"gather", "each node sums", "32 bytes a spring", "twice", "yes"},
                                           {"atomic", "atomic adds", "none", "once", "no"}};

std::vector<ResultRow> race_rows() {
  std::vector<ResultRow> rows{measured_row("serial", 1.5, 1.0),
                              in_six_rounds(measured_row("gather", 0.75, 2.0)),
                              failed_row("atomic", "failed: step 3 | node 7 is not finite"),
                              measured_row("hybrid", 1, 1.5), measured_row("serial", 0.25, 1.0)};
  rows.back().scene = "box";
  return rows;
}

ResultTable race_table_of(const std::vector<ResultRow>& rows) {
  return only_table(race_tables(race_methods)(rows, made_up_provenance()), "races");
}

TEST(RaceTable, AsCsvHasTimesRatiosAndWhatAWayCosts) {
  EXPECT_EQ(
      table_csv(race_table_of(race_rows()).data),
      "scene,nodes,springs_unique,integrator,method,threads,ms_per_step,ms_per_step_low,ms_per_step_high,"
      "speedup_vs_serial,extra_memory,springs_computed,same_bits,status\n"
      "cloth2500,2500,14502,semi-euler,serial,2,1.5,0.75,3,1,none,once,yes,ok\n"
      "cloth2500,2500,14502,semi-euler,gather,2,0.75,0.375,1.5,2,32 bytes a spring,twice,yes,ok\n"
      "cloth2500,2500,14502,semi-euler,atomic,2,,,,,none,once,no,failed: step 3 | node 7 is not finite\n"
      "box,2500,14502,semi-euler,serial,2,0.25,0.125,0.5,1,none,once,yes,ok\n");
}

TEST(RaceTable, AsMarkdownHasABlockASceneAndALineAWay) {
  const std::string page = markdown(race_table_of(race_rows()).page);
  EXPECT_THAT(page, HasSubstr("## cloth2500, semi-euler: 2,500 nodes, 14,502 springs\n"));
  EXPECT_THAT(page, HasSubstr("## box, semi-euler"));
  EXPECT_THAT(
      page,
      HasSubstr("| `gather` | **0.750** | 0.375 to 1.50 | 2.00× | 32 bytes a spring | twice | yes |\n"));
  EXPECT_THAT(page, HasSubstr("| `atomic` | failed | – | – | none | once | no |\n"));
  EXPECT_THAT(page, HasSubstr("- `atomic`, `semi-euler`: failed: step 3 \\| node 7"));
  EXPECT_THAT(page, HasSubstr("- `gather`: each node sums\n"));
  EXPECT_THAT(page, HasSubstr("Measured on A Processor (2 logical CPUs) with 2 threads"));
  EXPECT_THAT(page, Not(HasSubstr("hybrid")));
}

TEST(RaceTable, ShowsNoTimeThatWasNotVerified) {
  std::vector<ResultRow> rows{measured_row("gather", 0.75, 2.0)};
  rows[0].verified = false;
  const ResultTable table = race_table_of(rows);
  EXPECT_THAT(markdown(table.page), HasSubstr("| `gather` | failed | – | – |"));
  EXPECT_THAT(table_csv(table.data), HasSubstr("failed: not verified"));
}

TEST(RaceTable, MarksARatioThatItsTimesContradict) {
  std::vector<ResultRow> rows = race_rows();
  EXPECT_THAT(markdown(race_table_of(rows).page), Not(HasSubstr("†")));
  rows[1].speedup_vs_serial = 0.923;
  EXPECT_THAT(markdown(race_table_of(rows).page),
              HasSubstr("| `gather` | **0.750** | 0.375 to 1.50 | 0.923×† |"));
  EXPECT_THAT(markdown(race_table_of(rows).page),
              HasSubstr("|\n\n† the two times shown contradict this ratio: "));
}

TEST(RaceTable, IsNotMadeOfOtherBackends) {
  EXPECT_TRUE(
      race_tables(race_methods)(std::vector{measured_row("hybrid", 1, 1.0)}, made_up_provenance()).empty());
}

ResultRow row_of(const std::string& scene, std::uint64_t nodes, const std::string& backend, double ms) {
  ResultRow row = measured_row(backend, ms, 1.0);
  row.scene = scene;
  row.nodes = nodes;
  return row;
}

std::vector<ResultRow> scaling_rows() {
  ResultRow failed = failed_row("openmp", "unsupported: too large");
  failed.scene = "large";
  failed.nodes = 4'000'000;
  return {row_of("small", 1000, "serial", 0.5), row_of("small", 1000, "openmp", 0.25),
          row_of("large", 4'000'000, "serial", 3000), failed};
}

ResultTable scaling_table_of(const std::vector<ResultRow>& rows) {
  return only_table(scaling_tables("small")(rows, made_up_provenance()), "scaling");
}

TEST(ScalingTable, AsCsvHasNanosecondsANodeAndTheRatioToTheSameBackendsBase) {
  EXPECT_EQ(table_csv(scaling_table_of(scaling_rows()).data),
            "integrator,backend,scene,nodes,ms_per_step,ns_per_node,ns_per_node_low,ns_per_node_high,"
            "ratio_to_small,status\n"
            "semi-euler,serial,small,1000,0.5,500,250,1000,1,ok\n"
            "semi-euler,openmp,small,1000,0.25,250,125,500,1,ok\n"
            "semi-euler,serial,large,4000000,3000,750,375,1500,1.5,ok\n"
            "semi-euler,openmp,large,4000000,,,,,,unsupported: too large\n");
}

TEST(ScalingTable, AsMarkdownHasAColumnASceneAndALineABackend) {
  const std::string page = markdown(scaling_table_of(scaling_rows()).page);
  EXPECT_THAT(page, HasSubstr("| backend | small<br>1,000 | large<br>4,000,000 |\n"));
  EXPECT_THAT(page, HasSubstr("| `serial` | **500** (1.00×) | **750** (1.50×) |\n"));
  EXPECT_THAT(page, HasSubstr("| `openmp` | **250** (1.00×) | unsupported |\n"));
  EXPECT_THAT(page, HasSubstr("- `openmp`, `semi-euler`: unsupported: too large (`large`)\n"));
}

TEST(ScalingTable, HasNoRatioWhereTheBaseHasNoTime) {
  std::vector<ResultRow> rows = scaling_rows();
  rows[0].verified = false;
  const ResultTable table = scaling_table_of(rows);
  EXPECT_THAT(markdown(table.page), HasSubstr("| `serial` | failed | **750** |\n"));
  EXPECT_THAT(table_csv(table.data), HasSubstr("serial,large,4000000,3000,750,375,1500,,ok\n"));
  EXPECT_TRUE(scaling_tables("small")({}, made_up_provenance()).empty());
}

const std::vector<StructureRow> structure_rows{{"box-small", 700, 4307, 12921, 3256, 4.25},
                                               {"torus-large", 1977, 13012, 39036, 10000, 1.5},
                                               {"torus-small", 621, 3690, 11070, 2000, 2},
                                               {"my-own", 4, 6, 18, 1, 70.5}};

TEST(StructureTable, AsCsvHasOurMeshesBesideThePublishedOnes) {
  EXPECT_EQ(table_csv(structure_table(structure_rows, {}).data),
            "scene,nodes,springs_unique,springs_published,tetrahedra,smallest_dihedral_angle_deg,paper_nodes,"
            "paper_springs,same_as_paper\n"
            "box-small,700,4307,12921,3256,4.25,700,12921,true\n"
            "torus-large,1977,13012,39036,10000,1.5,1977,39033,false\n"
            "torus-small,621,3690,11070,2000,2,620,11070,false\n"
            "my-own,4,6,18,1,70.5,,,\n");
}

TEST(StructureTable, AsMarkdownShowsOnlyThePapersBodiesAndSaysWhichDiffer) {
  const std::string page = markdown(structure_table(structure_rows, {}).page);
  EXPECT_THAT(
      page, HasSubstr("| box | small | 700 | **700** | 12,921 | **12,921** | 4,307 | 3,256 | 4.25° | yes |"));
  EXPECT_THAT(
      page,
      HasSubstr(
          "| torus | large | 1,977 | **1,977** | 39,033 | **39,036** | 13,012 | 10,000 | 1.50° | **no** |"));
  EXPECT_THAT(page, HasSubstr("three times the unique edges, by inference"));
  EXPECT_THAT(page, Not(HasSubstr("my-own")));
}

ResultRow row_in_ranks(const std::string& scene, std::uint64_t nodes, const std::string& backend, int ranks,
                       double ms) {
  ResultRow row = row_of(scene, nodes, backend, ms);
  row.threads = ranks;
  row.ms_per_step_low = row.ms_per_step_high = ms;
  row.rounds = 6;
  row.packing_share = 0;
  row.messages_per_step = 0;
  row.bytes_per_step = 0;
  return row;
}

/// 100 x 100 nodes, shared by two processes and twice as wide: two columns of 100 nodes are 4,800 bytes.
std::vector<ResultRow> cluster_of_two() {
  std::vector<ResultRow> rows{
      row_in_ranks("square", 10'000, "openmp", 1, 1.75), row_in_ranks("square", 10'000, "mpi:1", 1, 1.8),
      row_in_ranks("square", 10'000, "mpi:2", 2, 1.25), row_in_ranks("square", 10'000, "mpi-copies:2", 2, 2),
      row_in_ranks("square-x2", 20'000, "mpi:2", 2, 2.5)};
  for (ResultRow* row : {&rows[2], &rows[4]}) {
    row->note = "Open MPI v4.1.4, 2 ranks of 1 thread, AVX3, 1 step an exchange";
    row->messages_per_step = 1;
    row->bytes_per_step = 4800;
    row->latency_us = 100;
    row->link_gigabytes_per_second = 0.048;
  }
  return rows;
}

Provenance provenance_of_two() {
  Provenance provenance = made_up_provenance();
  provenance.backend_programs = {
      {.name = "mpi-copies:2", .ranks = 2}, {.name = "mpi:1", .ranks = 1}, {.name = "mpi:2", .ranks = 2}};
  return provenance;
}

std::vector<ResultTable> tables_of_two(const std::vector<ResultRow>& rows) {
  return cluster_tables({{"semi-euler", 1}})(rows, provenance_of_two());
}

std::vector<std::string> column_of_two(std::string_view name) {
  const CsvTable table("cluster.csv", table_csv(tables_of_two(cluster_of_two()).front().data));
  std::vector<std::string> values;
  for (std::size_t row = 0; row < table.size(); ++row) values.push_back(table.text(row, table.column(name)));
  return values;
}

TEST(ClusterTable, TellsWideScenesFromOthers) {
  EXPECT_EQ(wide_scene("cloth10k-x4").base, "cloth10k");
  EXPECT_EQ(wide_scene("cloth10k-x4").times, 4);
  for (const std::string_view scene : {"cloth10k", "cloth-x1", "cloth-xl", "jeans4k-hip88", "a-x"}) {
    EXPECT_EQ(wide_scene(scene).base, scene);
    EXPECT_EQ(wide_scene(scene).times, 1);
  }
}

TEST(ClusterTable, HoldsEveryRowAgainstOneProcessAndAgainstCopies) {
  EXPECT_THAT(column_of_two("scaling"), ElementsAre("one process", "strong", "strong", "copies", "weak"));
  EXPECT_THAT(column_of_two("ranks"), ElementsAre("0", "1", "2", "2", "2"));
  EXPECT_THAT(column_of_two("efficiency"), ElementsAre("", "1", "0.72", "", "0.72"));
  EXPECT_THAT(column_of_two("efficiency_against_copies"), ElementsAre("", "", "0.8", "", "0.8"));
  // Half of the 2 ms of a copy, or all of it, 0.1 ms of latency, and 4,800 bytes at 0.048 GB/s.
  const std::vector<std::string> modelled = column_of_two("modelled_ms_per_step");
  EXPECT_THAT(modelled, ElementsAre("", "", testing::_, "", testing::_));
  EXPECT_NEAR(std::stod(modelled[2]), 1 + 0.1 + 0.1, 1e-12);
  EXPECT_NEAR(std::stod(modelled[4]), 2 + 0.1 + 0.1, 1e-12);
}

TEST(ClusterTable, ShowsOnlyWhatAProgramTellsOfItsMessages) {
  std::vector<ResultRow> rows = cluster_of_two();
  rows[2].messages_per_step.reset();
  rows[4].bytes_per_step.reset();
  const std::string page = markdown(tables_of_two(rows).front().page);
  EXPECT_THAT(page, HasSubstr(" | 4,800 | – | "));
  EXPECT_THAT(page, HasSubstr(" | – | 1.00 | "));
}

TEST(ClusterTable, CountsColumnsThatTwoProcessesCompute) {
  // 100 x 400 nodes in four processes, two steps of two stages an exchange: eight columns of 100 nodes come
  // from each side, and the four stages compute 6, 4, 2 and 0 of them again.
  const auto modelled = [](std::uint64_t nodes) {
    std::vector<ResultRow> rows{row_in_ranks("long", nodes, "mpi:4", 4, 1),
                                row_in_ranks("long", nodes, "mpi-copies:4", 4, 0.08)};
    for (ResultRow& row : rows) row.integrator = "midpoint";
    rows[0].note = "4 ranks of 1 thread, 2 steps an exchange";
    rows[0].bytes_per_step = 2 * 8 * 100 * 24 / 2;
    rows[0].latency_us = 100;
    rows[0].link_gigabytes_per_second = 0.048;
    Provenance provenance = made_up_provenance();
    provenance.backend_programs = {{.name = "mpi:4", .ranks = 4}, {.name = "mpi-copies:4", .ranks = 4}};
    const std::vector<ResultTable> tables = cluster_tables({{"midpoint", 2}})(rows, provenance);
    const CsvTable table("cluster.csv", table_csv(tables.front().data));
    return table.text(0, table.column("modelled_ms_per_step"));
  };
  // A node's stage takes a copy 1 ns.
  EXPECT_NEAR(std::stod(modelled(40'000)), (1e-6 * 100 * (4 * 100 + 2 * (6 + 4 + 2 + 0)) + 0.1 + 0.8) / 2,
              1e-12);
  EXPECT_EQ(modelled(2'800), "") << "seven columns each, of which neighbours repeat eight";
}

TEST(ClusterTable, AsCsvHasSharesEfficienciesAndTheModel) {
  EXPECT_THAT(
      table_csv(tables_of_two(cluster_of_two()).front().data),
      HasSubstr("\nstrong,square,10000,semi-euler,mpi:2,2,2,1.25,1.25,1.25,0.9375,0,0.0625,4800,1,100,"
                "0.048,0.72,0.8,1.2"));
}

TEST(ClusterTable, AsAPageHasBothScalingsAndSaysHowGoodTheModelIs) {
  const std::string page = markdown(tables_of_two(cluster_of_two()).front().page);
  EXPECT_THAT(page, HasSubstr("10,000 nodes for all processes (strong scaling)"));
  EXPECT_THAT(page, HasSubstr("10,000 nodes per process (weak scaling)"));
  EXPECT_THAT(page, HasSubstr("within 12 % of the measured time in all 2 rows"));
  EXPECT_THAT(page,
              HasSubstr("| `mpi:2` on `square-x2` | **2.50** | 2.50 to 2.50 | 93.8 | 0.0 | 6.2 | 4,800 | "
                        "1.00 | 0.72 | 0.80 | 2.20 (0.880×) |"));
}

TEST(ClusterTable, HasNoNumbersOfRowsThatDoNotCount) {
  std::vector<ResultRow> rows = cluster_of_two();
  rows[1].verified = false;
  rows[3] = failed_row("mpi-copies:2", "not timed: 2 ranks of 1 thread on 1 processor of a machine");
  rows[3].scene = "square";
  const std::vector<ResultTable> tables = tables_of_two(rows);
  const std::string page = markdown(tables.front().page);
  EXPECT_THAT(page, HasSubstr("| `mpi:1` | failed |"));
  EXPECT_THAT(page, HasSubstr("| `mpi-copies:2` | not timed |"));
  EXPECT_THAT(page, Not(HasSubstr("The model is within")));
}

}  // namespace
}  // namespace mssim
