#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "commands/shared/command.h"
#include "commands/shared/exit_code.h"
#include "tests/support/open_count.h"
#include "tests/support/scene_files.h"
#include "tests/support/temporary_folder.h"

namespace mssim {
namespace {

int run_with(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "mssim");
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  return run_program(static_cast<int>(arguments.size()), pointers.data());
}

class SceneReadingTest : public TemporaryFolderTest {
 protected:
  /// How often these arguments, which must end well, have the file of `scene`, which stands behind them,
  /// opened.
  int openings(std::vector<std::string> arguments, const std::string& scene = "cloth2500") const {
    const std::filesystem::path file = put("mine.json", text_of(source_file("scenes/" + scene + ".json")));
    OpenCount count(file);
    arguments.push_back(file.string());
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    const int code = run_with(std::move(arguments));
    const std::string said = testing::internal::GetCapturedStdout() + testing::internal::GetCapturedStderr();
    EXPECT_EQ(code, exit_ok) << said;
    return count.value();
  }
};

TEST_F(SceneReadingTest, IsDoneOnceByABench) {
  const std::string out = (folder() / "out").string();
  EXPECT_EQ(openings({"bench", "--backend", "serial", "--integrator", "semi-euler", "--rounds", "1",
                      "--threads", "1", "--trace", "--out", out, "--scene"}),
            1);
  EXPECT_EQ(openings({"bench", "--backend", "serial", "--integrator", "semi-euler", "--rounds", "1",
                      "--threads", "1", "--verified", out, "--scene"}),
            1);
}

TEST_F(SceneReadingTest, IsDoneOnceByADryRun) {
  EXPECT_EQ(openings({"bench", "--dry-run", "--time-budget", "1000", "--scene"}), 1);
}

TEST_F(SceneReadingTest, IsDoneOnceByARun) {
  EXPECT_EQ(openings({"run", "--backend", "serial", "--duration", "0.001", "--fps", "1000", "--trace",
                      (folder() / "trace.h5").string(), "--scene"}),
            1);
}

TEST_F(SceneReadingTest, IsDoneOnceByACheck) {
  EXPECT_EQ(openings({"check"}), 1);
  EXPECT_EQ(openings({"check"}, "jeans1k"), 1);
}

}  // namespace
}  // namespace mssim
