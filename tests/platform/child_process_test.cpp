#include "platform/child_process.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/temporary_folder.h"

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

TEST_F(ChildProcesses, MayWriteMoreThanAPipeHolds) {
  const ChildProcess much = shell(
      "i=0; while [ $i -lt 3000 ]; do echo 0123456789012345678901234567890123456789; "
      "i=$((i + 1)); done; echo end");
  const std::vector<ChildResult> results = run_together(std::vector{much, much});
  ASSERT_EQ(results.size(), 2U);
  for (const ChildResult& result : results) {
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.output.size(), 64U * 1024);
    EXPECT_THAT(result.output, testing::EndsWith("789\nend\n"));
  }
}

TEST_F(ChildProcesses, MayBeNone) { EXPECT_TRUE(run_together({}).empty()); }

}  // namespace
}  // namespace mssim
