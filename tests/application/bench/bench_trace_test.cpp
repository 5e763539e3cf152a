#include <gtest/gtest.h>

#include "application/bench/bench_plan.h"
#include "application/bench/bench_results.h"
#include "application/bench/bench_run.h"
#include "output/folders/provenance_file.h"
#include "tests/support/trace_fixture.h"

namespace mssim {
namespace {

class BenchTraceTest : public TemporaryFolderTest {};

TEST_F(BenchTraceTest, HasTheProvenanceOfTheBench) {
  BenchOptions options;
  options.scenes = {"cloth2500", "cloth4900"};
  options.backends = {"serial"};
  options.integrators = {"semi-euler"};
  options.execution.threads = 2;
  options.rounds = 1;
  options.output.folder = (folder() / "out").string();
  options.output.trace = true;
  BenchPlan plan = plan_of(options);
  BenchResults results(plan);
  TimeBudget budget(plan.time_budget_s, times_of(plan.timed));
  measure_scenes(plan, budget, StopRequest(), results);
  const std::string expected = provenance_text(plan.provenance);
  EXPECT_EQ(text_of(folder() / "out/provenance.json"), expected + '\n');
  for (const std::string& scene : options.scenes)
    EXPECT_EQ(text_in(open(folder() / "out/traces" / (scene + "-serial-semi-euler.h5")).get(),
                      "/parameters/provenance"),
              expected);
}

}  // namespace
}  // namespace mssim
