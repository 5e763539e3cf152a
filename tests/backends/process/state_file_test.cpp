#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "backends/process/exchanged_files.h"
#include "tests/support/temporary_folder.h"

namespace mssim {
namespace {

class StateFileTest : public TemporaryFolderTest {
 protected:
  /// Why the file, as it is, is no state.
  std::string failure() const {
    try {
      file_.read();
    } catch (const StateFileFailure& failure) {
      return failure.what();
    }
    return "none";
  }

  /// Writes numbers at the start of the file, as a program does.
  void put(const std::vector<double>& numbers) const {
    std::fstream stream(file_.path(), std::ios::in | std::ios::out | std::ios::binary);
    stream.write(reinterpret_cast<const char*>(numbers.data()),
                 static_cast<std::streamsize>(numbers.size() * sizeof(double)));
  }

  StateFile file_{2, folder()};
  const State state_{{{1, 2, 3}, {4, 5, 6}}, {{7, 8, 9}, {10, 11, 12}}};
};

TEST_F(StateFileTest, HoldsPositionsAndThenVelocities) {
  file_.write(state_);
  std::ifstream stream(file_.path(), std::ios::binary);
  std::vector<double> numbers(13);
  stream.read(reinterpret_cast<char*>(numbers.data()), 13 * sizeof(double));
  EXPECT_EQ(stream.gcount(), 12 * sizeof(double));
  for (std::size_t i = 0; i < 12; ++i) EXPECT_EQ(numbers[i], static_cast<double>(i + 1));
  const State back = file_.read();
  EXPECT_EQ(back.position[1].z, 6);
  EXPECT_EQ(back.velocity[1].x, 10);
}

TEST_F(StateFileTest, SeesWhatWasNotWritten) {
  file_.write(state_);
  file_.clear();
  EXPECT_EQ(failure(), "wrote 0 of the 4 positions and velocities of the state file");
  put({1, 2, 3, 4, 5, 6, 7, 8});
  EXPECT_EQ(failure(), "wrote 2 of the 4 positions and velocities of the state file");
}

TEST_F(StateFileTest, PassesOnNumbersThatAreNotFinite) {
  file_.clear();
  std::vector<double> numbers(12, 1.0);
  numbers[4] = std::numeric_limits<double>::quiet_NaN();
  numbers[5] = -std::numeric_limits<double>::infinity();
  put(numbers);
  const State back = file_.read();
  EXPECT_TRUE(std::isnan(back.position[1].y));
  EXPECT_TRUE(std::isinf(back.position[1].z));
}

TEST_F(StateFileTest, SurvivesBeingCut) {
  std::filesystem::resize_file(file_.path(), 41);
  EXPECT_EQ(failure(), "left a state file of 41 bytes instead of 96");
  std::filesystem::resize_file(file_.path(), 0);
  EXPECT_EQ(failure(), "left a state file of 0 bytes instead of 96");
  file_.write(state_);
  EXPECT_EQ(failure(), "none");
}

TEST_F(StateFileTest, GoesAway) {
  std::filesystem::path path;
  {
    const StateFile other(3, folder());
    path = other.path();
    EXPECT_TRUE(std::filesystem::exists(path));
  }
  EXPECT_FALSE(path.string().starts_with("/dev/shm") && std::filesystem::exists(path));
}

}  // namespace
}  // namespace mssim
