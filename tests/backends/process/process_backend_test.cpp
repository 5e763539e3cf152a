#include "backends/process/process_backend.h"

#include <cstdlib>

#include "backends/backends.h"
#include "integrators/all_integrators.h"
#include "platform/files.h"
#include "tests/support/backend_checks.h"
#include "tests/support/files_fixture.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

/// tests/support/own_backend.cpp, with what it does wrong.
BackendProgram program_that(const std::string& mistake) {
  BackendProgram program;
  program.name = mistake.empty() ? "right" : mistake;
  program.program = data_folder().parent_path().parent_path() / "bin" / "own_backend";
  program.command = {program.program.string()};
  if (!mistake.empty()) program.command.push_back(mistake);
  program.folder = std::filesystem::current_path();
  program.time_limit_s = 60;
  return program;
}

std::unique_ptr<Backend> make(const BackendProgram& program, const System& system,
                              const Integrator& integrator = integrators.front(), int threads = 2) {
  return make_process_backend(program, system, integrator, backend_dt_of(integrator),
                              {.threads = threads, .scene = "made up"});
}

/// What the program's failure says, where some steps of a small cloth fail.
BackendFailure failure_of(const std::string& mistake) {
  const System system = cloth_system(4, 5);
  const BackendProgram program = program_that(mistake);
  try {
    const auto backend = make(program, system);
    backend->set_state(system.start);
    for (int steps = 0; steps < 5; ++steps) backend->step(10);
    backend->state();
  } catch (const BackendFailure& failure) {
    return failure;
  }
  return {"none", ""};
}

TEST(ProcessBackend, SaysWhatProcessesSpendOnEachOtherWhereTheProgramTells) {
  const System system = cloth_system(4, 5);
  const BackendProgram silent = program_that(""), telling = program_that("tells-costs"),
                       excessive = program_that("many-costs");
  EXPECT_EQ(make(silent, system)->communication(), std::nullopt);
  const auto backend = make(telling, system);
  backend->step(3);
  backend->rest();
  const std::optional<Communication> costs = backend->communication();
  ASSERT_TRUE(costs);
  EXPECT_EQ(costs->waiting, 0.25);
  EXPECT_EQ(costs->bytes, 96);
  EXPECT_EQ(costs->messages, 2);
  for (const auto& untold : {costs->packing, costs->latency_s, costs->bytes_per_second})
    EXPECT_EQ(untold, std::nullopt);
  backend->step(1);
  EXPECT_TRUE(backend->communication());
  const auto other = make(excessive, system);
  EXPECT_THROW(other->communication(), BackendFailure);
}

/// Every row of the table, by name, which the program is told as stages and assignments. It takes its steps
/// with the header of users' programs.
class OwnProgram : public testing::TestWithParam<std::string_view> {};
INSTANTIATE_TEST_SUITE_P(Each, OwnProgram, testing::ValuesIn(names_of(integrators)), ByName());

TEST_P(OwnProgram, AgreesWithTheReference) {
  const BackendProgram program = program_that("");
  const Integrator& integrator = *find_integrator(GetParam());
  for (const System& system : {cloth_system(12, 9), solid_block(4, 4, 4, 0.001)}) {
    const auto backend = make(program, system, integrator);
    const auto reference = make_reference(system, integrator, backend_dt_of(integrator));
    for (Backend* one : {backend.get(), reference.get()}) {
      one->set_state(system.start);
      one->step(3);
      one->step(200);
    }
    const State found = backend->state(), expected = reference->state();
    EXPECT_LT(largest_distance(found.position, expected.position), 1e-11);
    EXPECT_LT(largest_distance(found.velocity, expected.velocity), 1e-8);
    EXPECT_TRUE(has_met_floor(system, expected) || !system.pins.empty());
  }
}

TEST(ProcessBackend, SaysWhatTheProgramSaysOfItself) {
  const System system = cloth_system(4, 5);
  const BackendProgram program = program_that("");
  const auto backend = make(program, system);
  EXPECT_EQ(backend->device(), "cpu");
  EXPECT_TRUE(backend->runs_on_host());
  EXPECT_EQ(backend->threads(), 1);
  EXPECT_EQ(backend->note(), "double precision; a list of springs");
  EXPECT_FALSE(backend->is_in_single());
  EXPECT_FALSE(make(program, system, *find_integrator("verlet"))->is_in_single());
}

TEST(ProcessBackend, GoesOnAfterARest) {
  const System system = cloth_system(4, 5);
  const BackendProgram program = program_that("");
  const auto backend = make(program, system);
  backend->set_state(system.start);
  backend->step(4);
  backend->rest();
  backend->rest();
  const State paused = state_after(*backend, 6);
  backend->set_state(system.start);
  EXPECT_EQ(largest_distance(paused.position, state_after(*backend, 10).position), 0);
}

TEST(ProcessBackend, CountsTheProcessorTimeOfTheProgram) {
  const System system = cloth_system(30, 30);
  const BackendProgram program = program_that("");
  const auto backend = make(program, system);
  const double before = backend->processor_seconds();
  backend->step(1000);
  EXPECT_GT(backend->processor_seconds() - before, 0.005);
  backend->rest();
  const double after = backend->processor_seconds();
  EXPECT_EQ(backend->processor_seconds(), after);
}

// What else programs do wrong, and what they are measured to be: tests/commands/own_backend_test.sh.
TEST(ProcessBackend, TellsHowAProgramFails) {
  EXPECT_STREQ(failure_of("nonsense").what(),
               "nonsense answered \"hello\" to \"step 10\", where done, or failed and a reason, is expected");
  EXPECT_STREQ(failure_of("fails").what(), "fails failed at \"step 10\": a spring has snapped");
  EXPECT_EQ(failure_of("exits").output, "out of cake\n");
  EXPECT_STREQ(failure_of("closes").what(), "closes closed its connection before it answered \"step 10\"");
  EXPECT_STREQ(
      failure_of("too-few").what(),
      "too-few wrote 39 of the 40 positions and velocities of the state file when it was asked \"get\"");
  EXPECT_STREQ(failure_of("cuts-state").what(),
               "cuts-state left a state file of 936 bytes instead of 960 when it was asked \"get\"");
}

TEST(ProcessBackend, IsNotStartedForWhatItDoesNotHave) {
  BackendProgram program = program_that("ends-early");
  program.steps_cloths = false;
  const System system = cloth_system(4, 5);
  EXPECT_THROW(make(program, system), Unsupported);
  program.steps_cloths = true;
  program.integrators = {"rk4"};
  EXPECT_THROW(make(program, system), Unsupported);
  program.missing = "there is no such program";
  EXPECT_THROW(make(program, system, *find_integrator("rk4")), Unavailable);
}

/// A test whose temporary files lie in a folder of its own. StateFileTest looks at those in shared memory.
class ProcessBackendFiles : public TemporaryFolderTest {
 protected:
  ProcessBackendFiles() { ::setenv("TMPDIR", folder().c_str(), 1); }
  bool is_empty() const { return std::filesystem::is_empty(folder()); }

 private:
  KeptVariables kept_{"TMPDIR"};
};

TEST_F(ProcessBackendFiles, GoAwayWithTheBackend) {
  const System system = cloth_system(4, 5);
  const BackendProgram program = program_that("");
  {
    const auto backend = make(program, system);
    EXPECT_FALSE(is_empty());
  }
  EXPECT_TRUE(is_empty());
  EXPECT_NE(std::string(failure_of("nonsense").what()), "none");
  EXPECT_TRUE(is_empty());
}

}  // namespace
}  // namespace mssim
