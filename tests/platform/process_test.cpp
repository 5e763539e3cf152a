#include "platform/process.h"

#include "tests/support/address_space.h"
#include "tests/support/files_fixture.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

class ChildProcesses : public TemporaryFolderTest {
 protected:
  ChildProcess shell(const std::string& commands) const {
    return {"/bin/sh", {"-c", commands}, {}, folder(), 60};
  }
};

TEST_F(ChildProcesses, RunAtTheSameTimeAndGiveTheirResultsInOrder) {
  // Each waits, ten seconds at most, for what the other has to make.
  const std::string wait =
      "i=0; until [ -e $0 ]; do i=$((i + 1)); [ $i -lt 1000 ] || exit 9; sleep 0.01; done; ";
  ChildProcess first = shell("touch first; " + wait + "echo one; exit 3");
  first.arguments.emplace_back("second");
  ChildProcess second = shell("touch second; " + wait + "echo two; kill -TERM $$");
  second.arguments.emplace_back("first");
  const std::vector<ChildResult> results = run_together(std::vector{first, second});
  ASSERT_EQ(results.size(), 2U);
  EXPECT_EQ(results[0].exit_code, 3);
  EXPECT_EQ(results[0].output, "one\n");
  EXPECT_EQ(results[1].signal, SIGTERM);
  EXPECT_EQ(results[1].output, "two\n");
}

TEST_F(ChildProcesses, ThatCannotBeStartedAreNamedWhenTheOthersHaveEnded) {
  ChildProcess missing = shell("");
  missing.program = folder() / "missing";
  EXPECT_THROW(run_together(std::vector{shell("touch made"), missing}), std::runtime_error);
  EXPECT_TRUE(exists(folder() / "made"));
  EXPECT_THROW(run(missing), std::runtime_error);
}

// The system's reason, that there is no such file, is the same for both.
TEST_F(ChildProcesses, ThatHaveNoFolderAreNotTakenForMissingPrograms) {
  ChildProcess homeless = shell("");
  homeless.folder = folder() / "gone";
  EXPECT_THAT([&] { run(homeless); },
              testing::ThrowsMessage<std::runtime_error>(HasSubstr("entering its folder")));
}

TEST_F(ChildProcesses, MayWriteMoreThanAPipeHolds) {
  const ChildProcess much = shell(
      "i=0; while [ $i -lt 3000 ]; do echo 0123456789012345678901234567890123456789; "
      "i=$((i + 1)); done; echo end");
  const std::vector<ChildResult> results = run_together(std::vector{much, much});
  ASSERT_EQ(results.size(), 2U);
  for (const ChildResult& result : results) {
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.output.size(), 64U * 1024);
    EXPECT_THAT(result.output, EndsWith("789\nend\n"));
  }
}

TEST_F(ChildProcesses, AreEndedWithAllThatTheyStartedWhenTheirTimeIsOver) {
  for (const std::string hold : {"exec sleep 600", "sleep 600 & exit 3", "exec >&- 2>&-; sleep 600 & wait"}) {
    ChildProcess child = shell("echo begun; " + hold);
    child.elapsed_seconds = 1;
    const ChildResult result = run(child);
    EXPECT_EQ(result.output, "begun\n") << hold;
    if (hold.ends_with("exit 3")) {
      EXPECT_EQ(result.exit_code, 3) << "what it started may be ended without it";
    } else {
      EXPECT_EQ(result.signal, SIGKILL) << hold;
      EXPECT_TRUE(result.out_of_time) << hold;
    }
  }
}

TEST_F(ChildProcesses, ThatTakeMoreThanTheyMaySayThat) {
  if (!AddressSpaceLimit(rlim_t{1} << 46).holds()) GTEST_SKIP() << "this system limits no address space";
  constexpr std::uint64_t memory_bytes = std::uint64_t{64} << 20;
  // A child begins with the memory of this process, which is not to be taken for its own.
  for (const std::uint64_t held : {std::uint64_t{0}, 2 * memory_bytes}) {
    const std::string here(held, 'x');
    ChildProcess child = shell("exec awk 'BEGIN { while (1) text[n++] = n \" is put into memory\" }'");
    child.memory_bytes = memory_bytes;
    const ChildResult filled = run(child);
    EXPECT_TRUE(filled.out_of_memory) << here.size();
    EXPECT_FALSE(filled.out_of_time);
    child = shell("exec false");
    child.memory_bytes = memory_bytes;
    EXPECT_FALSE(run(child).out_of_memory) << here.size();
  }
}

TEST(TrialProcess, SaysWhetherWorkEndsAndChangesNothingHere) {
  int here = 0;
  EXPECT_TRUE(ends_in_trial([&] { here = 1; }, 10));
  EXPECT_TRUE(ends_in_trial([] { throw std::runtime_error("refused"); }, 10));
  EXPECT_EQ(here, 0);
  for (const int crash : {SIGSEGV, SIGFPE, SIGABRT})
    EXPECT_FALSE(ends_in_trial([&] { std::raise(crash); }, 10)) << crash;
}

TEST(TrialProcess, EndsWorkThatDoesNot) {
  volatile bool goes_on = true;
  EXPECT_FALSE(ends_in_trial(
      [&] {
        while (goes_on) {
        }
      },
      1));
}

}  // namespace
}  // namespace mssim
