#include <gtest/gtest.h>

#include <sstream>
#include <string>

#include "ranks/requests.h"

namespace mssim {
namespace {

/// What is made of a text that comes in pieces of so many bytes.
struct Heard {
  std::string reason, passed_on;
  bool started, failed;
};

Heard heard(const std::string& text, std::size_t piece = 7) {
  std::ostringstream passed_on;
  LauncherOutput output(passed_on);
  for (std::size_t i = 0; i < text.size(); i += piece) output.take(std::string_view(text).substr(i, piece));
  return {output.reason(), passed_on.str(), output.ranks_started(), output.rank_has_failed()};
}

const std::string dashes(74, '-');

TEST(LauncherOutput, SaysThatTheRanksHaveStartedAndPassesOnTheRest) {
  const Heard output =
      heard("first\nmssim-mpi: all ranks have started\nmpirun: Forwarding signal 18 to job\nsecond\n");
  EXPECT_TRUE(output.started);
  EXPECT_EQ(output.passed_on, "first\nsecond\n");
  EXPECT_FALSE(output.failed);
  EXPECT_FALSE(heard("first\n").started);
  EXPECT_TRUE(heard("mssim-mpi: rank 1 on a: it is broken\n").failed);
}

TEST(LauncherOutput, TakesNoFrameForAReason) {
  const std::string asterisks(74, '*');
  EXPECT_EQ(heard("sh: mpirunx: not found\n" + asterisks + "\n").reason, "sh: mpirunx: not found");
  EXPECT_EQ(heard(asterisks + "\nno slots are left\n" + asterisks + "\n").reason, "no slots are left");
}

TEST(LauncherOutput, TakesWhatARankSaysFirst) {
  EXPECT_EQ(heard("mssim-mpi: rank 1 on a: it is broken\n" + dashes +
                  "\nMPI_ABORT was invoked on rank 1 in communicator MPI_COMM_WORLD\n" + dashes +
                  "\nmssim-mpi: rank 0 on a: it is broken too\n")
                .reason,
            "rank 1 on a: it is broken");
}

TEST(LauncherOutput, TakesWhatTheLauncherSaysOfARank) {
  EXPECT_EQ(
      heard(dashes + "\nPrimary job  terminated normally, but 1 process returned\na non-zero exit code.\n" +
            dashes + "\n" + dashes +
            "\nmpirun noticed that process rank 1 with PID 0 on node b exited on signal 9 (Killed).\n" +
            dashes + "\n")
          .reason,
      "mpirun noticed that process rank 1 with PID 0 on node b exited on signal 9 (Killed).");
  EXPECT_EQ(heard("srun: error: b: task 1: Killed\nsrun: launch/slurm: done\n").reason,
            "srun: error: b: task 1: Killed");
}

TEST(LauncherOutput, TakesTheFirstParagraphBetweenDashesBehindWhatSshSays) {
  const std::string slots =
      dashes +
      "\nThere are not enough slots available in the system to satisfy the 3\nslots that were "
      "requested by the application:\n\n  mssim-mpi\n\nEither request fewer slots.\n" +
      dashes + "\n";
  const std::string reason =
      "There are not enough slots available in the system to satisfy the 3 slots that were requested by the "
      "application:";
  EXPECT_EQ(heard(slots).reason, reason);
  EXPECT_EQ(heard("ssh: connect to host b port 22: No route to host\n" + slots).reason,
            "ssh: connect to host b port 22: No route to host; " + reason);
}

TEST(LauncherOutput, DoesNotTakeANoteOfOpenMpiForAReason) {
  EXPECT_EQ(
      heard(
          "ssh: connect to host b port 22: No route to host\n"
          "[a:983] plm:rsh: Warning: setpgid(997,997) failed in parent with errno=Permission denied(13)\n\n" +
          dashes + "\nORTE was unable to reliably start one or more daemons.\n" + dashes + "\n")
          .reason,
      "ssh: connect to host b port 22: No route to host; ORTE was unable to reliably start one or more "
      "daemons.");
}

TEST(LauncherOutput, ElseTakesTheLastLine) {
  EXPECT_EQ(heard("one\ntwo\n\n").reason, "two");
  EXPECT_EQ(heard("").reason, "it printed nothing");
}

}  // namespace
}  // namespace mssim
