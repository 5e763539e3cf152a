#include <gtest/gtest.h>
#include <sys/inotify.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "commands/shared/command.h"
#include "commands/shared/exit_code.h"
#include "platform/descriptor.h"
#include "tests/support/scene_files.h"
#include "tests/support/temporary_folder.h"

namespace mssim {
namespace {

/// Counts how often a file is opened from now on.
class OpenCount {
 public:
  explicit OpenCount(const std::filesystem::path& file) : queue_(::inotify_init1(IN_NONBLOCK | IN_CLOEXEC)) {
    // Events that are alike and follow each other would be told as one; between two openings there is a
    // closing.
    if (::inotify_add_watch(queue_.get(), file.c_str(), IN_OPEN | IN_CLOSE) < 0)
      throw std::runtime_error("cannot watch " + file.string());
  }

  int value() const {
    int opened = 0;
    std::array<char, 4096> events{};
    ssize_t size = 0;
    while ((size = ::read(queue_.get(), events.data(), events.size())) > 0)
      for (std::size_t at = 0; at < static_cast<std::size_t>(size);) {
        inotify_event event{};
        std::memcpy(&event, events.data() + at, sizeof event);
        if (event.mask & IN_OPEN) ++opened;
        at += sizeof event + event.len;
      }
    return opened;
  }

 private:
  Descriptor queue_;
};

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
    const OpenCount count(file);
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
