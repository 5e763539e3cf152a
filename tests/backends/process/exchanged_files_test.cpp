#include "backends/process/exchanged_files.h"

#include <fstream>

#include "backends/process/process_backend.h"
#include "hdf5/hdf5.h"
#include "integrators/all_integrators.h"
#include "platform/files.h"
#include "tests/support/files_fixture.h"
#include "tests/support/output_fixture.h"
#include "tests/support/systems.h"
#include "tests/support/testing.h"
#include "tests/support/trace_fixture.h"

namespace mssim {
namespace {

TEST(MethodText, NamesStagesAndTerms) {
  EXPECT_EQ(method_text(*find_integrator("midpoint")),
            "integrator midpoint\n"
            "stage x v\n"
            "assign x_a 1 0 x 0.5 1 v\n"
            "assign v_a 1 0 v 0.5 1 a\n"
            "stage x_a v_a\n"
            "assign x_next 1 0 x 1 1 v_a\n"
            "assign v_next 1 0 v 1 1 a\n");
}

TEST(MethodText, WritesCoefficientsThatReadBack) {
  EXPECT_NE(
      method_text(*find_integrator("rk4-frozen")).find(" 0.16666666666666666 1 v 0.66666666666666663 1 "),
      std::string::npos);
}

class StateFileTest : public TemporaryFolderTest {
 protected:
  /// Why the file, as it is, is no state.
  std::string failure() const {
    return sentence_of<StateFileFailure>([&] { file_.read(); });
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
  EXPECT_EQ(failure(), "");
}

TEST_F(StateFileTest, NamesTheLimitThatItExceeds) {
  expect_in_child([&] {
    limit_file_size(1000);
    EXPECT_THAT(sentence_of<std::runtime_error>([&] { StateFile(1000, folder()); }),
                AllOf(HasSubstr("48000 bytes"), HasSubstr("ulimit -f")));
  });
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

/// A file that was written, read back by HDF5 alone.
class SystemFileTest : public TemporaryFolderTest {
 protected:
  void write(const System& system) {
    write_system(folder() / "system.h5", system);
    file_ = open_for_reading(folder() / "system.h5");
  }

  std::vector<double> doubles(const std::string& path) const {
    return read<double>(file_.get(), path, H5T_NATIVE_DOUBLE);
  }
  std::vector<std::uint32_t> counts(const std::string& path) const {
    return read<std::uint32_t>(file_.get(), path, H5T_NATIVE_UINT32);
  }
  std::vector<hsize_t> extents(const std::string& path) const { return shape_of(file_.get(), path); }
  std::string unit(const std::string& path) const { return text_attribute(file_.get(), path, "unit"); }

  Hdf5File file_;
};

std::vector<double> numbers_of(const std::vector<Vec3d>& vectors) {
  std::vector<double> numbers;
  for (const Vec3d& vector : vectors) numbers.insert(numbers.end(), {vector.x, vector.y, vector.z});
  return numbers;
}

TEST_F(SystemFileTest, HoldsACloth) {
  const System system = cloth_system(5, 7);
  write(system);
  EXPECT_THAT(extents("/position"), ElementsAre(35, 3));
  EXPECT_EQ(doubles("/position"), numbers_of(system.start.position));
  EXPECT_EQ(doubles("/velocity"), numbers_of(system.start.velocity));
  EXPECT_EQ(doubles("/mass"), system.node_mass);
  EXPECT_EQ(counts("/pins"), system.pins);
  EXPECT_THAT(extents("/springs"), ElementsAre(system.springs.size(), 2));
  const auto ends = counts("/springs"), kinds = counts("/kind");
  const auto rest_lengths = doubles("/rest_length");
  ASSERT_EQ(rest_lengths.size(), system.springs.size());
  for (std::size_t i = 0; i < system.springs.size(); ++i) {
    const Spring& spring = system.springs[i];
    EXPECT_EQ(ends[2 * i], spring.first);
    EXPECT_EQ(ends[2 * i + 1], spring.second);
    EXPECT_EQ(rest_lengths[i], spring.rest_length);
    EXPECT_EQ(kinds[i], spring.kind);
  }
  for (const SpringConstantInfo& constant : spring_constants) {
    const auto numbers = doubles(fmt::format("/{}", constant.name));
    ASSERT_EQ(numbers.size(), system.springs.size()) << constant.name;
    for (std::size_t i = 0; i < numbers.size(); ++i)
      EXPECT_EQ(numbers[i], system.materials[system.springs[i].kind].*constant.number) << constant.name;
  }
  EXPECT_THAT(doubles("/gravity"), ElementsAre(0, -9.81, 0));
  EXPECT_THAT(extents("/viscous_damping"), ElementsAre());
  EXPECT_THAT(doubles("/viscous_damping"), ElementsAre(system.viscous_damping));
  EXPECT_THAT(doubles("/floor/height"), ElementsAre(system.floor.height));
  EXPECT_THAT(doubles("/floor/restitution"), ElementsAre(system.floor.restitution));
  EXPECT_THAT(doubles("/floor/friction"), ElementsAre(system.floor.friction));
  EXPECT_THAT(counts("/grid/rows"), ElementsAre(5));
  EXPECT_THAT(counts("/grid/columns"), ElementsAre(7));
  EXPECT_THAT(doubles("/grid/spacing"), ElementsAre(0.01));
  EXPECT_FALSE(exists(file_.get(), "/tetrahedra"));
}

TEST_F(SystemFileTest, HoldsBodiesWithoutPins) {
  const System system = solid_block(3, 3, 3);
  write(system);
  const auto& mesh = std::get<TetrahedralMesh>(system.topology);
  EXPECT_THAT(extents("/tetrahedra"), ElementsAre(mesh.tetrahedra.size(), 4));
  EXPECT_EQ(counts("/tetrahedra")[5], mesh.tetrahedra[1][1]);
  EXPECT_THAT(extents("/pins"), ElementsAre(0));
  EXPECT_FALSE(exists(file_.get(), "/grid"));
}

TEST_F(SystemFileTest, SaysTheUnits) {
  write(cloth_system(3, 3));
  EXPECT_EQ(unit("/position"), "m");
  EXPECT_EQ(unit("/velocity"), "m/s");
  EXPECT_EQ(unit("/mass"), "kg");
  EXPECT_EQ(unit("/stiffness"), "N/m");
  EXPECT_EQ(unit("/damping"), "N s/m");
  EXPECT_EQ(unit("/gravity"), "m/s^2");
  EXPECT_EQ(unit("/viscous_damping"), "1/s");
  EXPECT_EQ(unit("/floor/height"), "m");
  EXPECT_EQ(H5Aexists_by_name(file_.get(), "/springs", "unit", H5P_DEFAULT), 0);
}

TEST_F(SystemFileTest, HoldsMoreRowsThanAreWrittenAtOnce) {
  const System system = cloth_system(150, 150);
  ASSERT_GT(system.springs.size(), 65536U);
  write(system);
  const auto ends = counts("/springs");
  ASSERT_EQ(ends.size(), 2 * system.springs.size());
  for (std::size_t i = 65530; i < 65542; ++i) EXPECT_EQ(ends[2 * i + 1], system.springs[i].second);
  EXPECT_EQ(ends.back(), system.springs.back().second);
}

TEST_F(SystemFileTest, ReplacesNothing) {
  write_system(folder() / "twice.h5", cloth_system(3, 3));
  EXPECT_THROW(write_system(folder() / "twice.h5", cloth_system(3, 3)), WriteError);
}

}  // namespace
}  // namespace mssim
