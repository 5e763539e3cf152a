#include <gtest/gtest.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <exception>
#include <filesystem>
#include <string>
#include <thread>

#include "tests/support/supervised_fixture.h"

namespace mssim {
namespace {

using namespace std::chrono_literals;

/// With children that leave the group and become orphans.
class SupervisedFamilies : public SupervisedProcesses {
 protected:
  void SetUp() override {
    int is_subreaper = 0;
    if (::prctl(PR_GET_CHILD_SUBREAPER, &is_subreaper) != 0)
      GTEST_SKIP() << "this emulator has no subreapers";
  }
};

/// A child, a session of its own, and a daemon that nobody of the family is the parent of, which all keep the
/// output open.
constexpr const char* family =
    "sleep 1000 & setsid sleep 1000 & (setsid sh -c 'sleep 1000 & sleep 1000 & wait' &); ";
constexpr std::size_t family_size = 5;

TEST_F(SupervisedFamilies, LeaveNothingWhenTheyEnd) {
  const ProgramEnd end =
      end_of(std::string(family) + "until [ -e end ]; do sleep 0.01; touch end; done; exit 4");
  EXPECT_EQ(end.exit_code, 4);
  EXPECT_TRUE(processes().empty());
}

TEST_F(SupervisedFamilies, LeaveNothingWhenTheyAreEnded) {
  {
    const SupervisedProcess process(shell(std::string(family) + "wait"));
    EXPECT_TRUE(soon([&] { return processes_of_program().size() == family_size + 1; }));
  }
  EXPECT_TRUE(processes().empty());
}

TEST_F(SupervisedFamilies, LeaveNothingThatForksAgainAndAgain) {
  // Each process of a chain starts the next one and ends; some leave the group.
  put("chain", "f() { f & }\nf\n");
  for (int i = 0; i < 5; ++i) {
    {
      const SupervisedProcess process(
          shell("sh ./chain & setsid sh ./chain & (setsid sh ./chain &); touch ready; sleep 1000"));
      EXPECT_TRUE(soon([&] { return exists(folder() / "ready"); }));
    }
    EXPECT_TRUE(processes().empty());
  }
}

TEST_F(SupervisedFamilies, AreGoneSoonAfterMssimWasKilled) {
  const pid_t mssim = ::fork();
  if (mssim == 0) {
    try {
      const SupervisedProcess process(shell(std::string(family) + "wait"));
      ::pause();
    } catch (const std::exception&) {
    }
    ::_exit(1);
  }
  EXPECT_TRUE(soon([&] { return processes_of_program().size() == family_size + 1; }));
  ::kill(mssim, SIGKILL);
  ::waitpid(mssim, nullptr, 0);
  EXPECT_TRUE(soon([&] { return processes().empty(); }));
}

TEST_F(SupervisedFamilies, LeaveNothingWhenTheirSupervisorIsToldToEnd) {
  const ProgramEnd end = end_of(std::string(family) + "kill -TERM $PPID; sleep 1000");
  EXPECT_EQ(end.signal, SIGKILL);
  EXPECT_TRUE(processes().empty());
}

TEST_F(SupervisedFamilies, StopAndGoOnWithAllThatTheyStarted) {
  SupervisedProcess process(shell(std::string(family) + "while :; do echo >>count; done"));
  ASSERT_TRUE(
      soon([&] { return processes_of_program().size() == family_size + 1 && exists(folder() / "count"); }));
  for (int i = 0; i < 2; ++i) {
    process.pause();
    EXPECT_TRUE(all_stopped(true));
    const auto count = file_size(folder() / "count");
    std::this_thread::sleep_for(50ms);
    EXPECT_EQ(file_size(folder() / "count"), count);
    process.resume();
    EXPECT_TRUE(all_stopped(false));
    EXPECT_TRUE(soon([&] { return file_size(folder() / "count") > count; }));
  }
  process.pause();
  EXPECT_EQ(process.end(0s).signal, SIGKILL);
  EXPECT_TRUE(processes().empty());
}

TEST_F(SupervisedFamilies, CountTheirProcessorTime) {
  // In a child that has been waited for, in an orphan that has ended, and in the program itself.
  const std::string work = "i=0; while [ $i -lt 200000 ]; do i=$((i + 1)); done; ";
  SupervisedProcess process(shell("(" + work + "); touch child; (setsid sh -c '" + work +
                                  "touch orphan' &); "
                                  "until [ -e go ]; do sleep 0.01; done; while :; do :; done"));
  ASSERT_TRUE(soon([&] { return exists(folder() / "child"); }));
  const double child = process.processor_seconds();
  EXPECT_GT(child, 0.02);
  ASSERT_TRUE(soon([&] { return exists(folder() / "orphan"); }));
  const double orphan = process.processor_seconds();
  EXPECT_GT(orphan, child + 0.3 * child);
  put("go", "");
  EXPECT_TRUE(soon([&] { return process.processor_seconds() > orphan + 0.2; }));
  const double before = process.processor_seconds();
  process.end(0s);
  EXPECT_GE(process.processor_seconds(), before);
  EXPECT_LT(process.processor_seconds(), before + 60);
}

}  // namespace
}  // namespace mssim
