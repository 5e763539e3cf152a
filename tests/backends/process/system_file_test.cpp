#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "backends/process/exchanged_files.h"
#include "hdf5/hdf5.h"
#include "platform/files.h"
#include "tests/support/cloth_system.h"
#include "tests/support/solid_system.h"
#include "tests/support/temporary_folder.h"

namespace mssim {
namespace {

using testing::ElementsAre;

/// A file that was written, read back by HDF5 alone.
class SystemFileTest : public TemporaryFolderTest {
 protected:
  void write(const System& system) {
    write_system(folder() / "system.h5", system);
    file_ = open_for_reading(folder() / "system.h5");
  }

  template <class Number>
  std::vector<Number> read(const std::string& path, hid_t type) const {
    const Hdf5Dataset dataset = open_dataset(file_.get(), path);
    const Hdf5Space space(H5Dget_space(dataset.get()), path);
    std::vector<Number> numbers(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space.get())));
    checked(H5Dread(dataset.get(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()), path);
    return numbers;
  }
  std::vector<double> doubles(const std::string& path) const { return read<double>(path, H5T_NATIVE_DOUBLE); }
  std::vector<std::uint32_t> counts(const std::string& path) const {
    return read<std::uint32_t>(path, H5T_NATIVE_UINT32);
  }
  std::vector<hsize_t> extents(const std::string& path) const {
    const Hdf5Dataset dataset = open_dataset(file_.get(), path);
    const Hdf5Space space(H5Dget_space(dataset.get()), path);
    std::vector<hsize_t> all(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space.get())));
    H5Sget_simple_extent_dims(space.get(), all.data(), nullptr);
    return all;
  }
  std::string unit(const std::string& path) const { return read_text_attribute(file_.get(), path, "unit"); }

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
  const auto rest_lengths = doubles("/rest_length"), stiffness = doubles("/stiffness"),
             damping = doubles("/damping");
  ASSERT_EQ(rest_lengths.size(), system.springs.size());
  for (std::size_t i = 0; i < system.springs.size(); ++i) {
    const Spring& spring = system.springs[i];
    EXPECT_EQ(ends[2 * i], spring.first);
    EXPECT_EQ(ends[2 * i + 1], spring.second);
    EXPECT_EQ(rest_lengths[i], spring.rest_length);
    EXPECT_EQ(kinds[i], spring.kind);
    EXPECT_EQ(stiffness[i], system.materials[spring.kind].stiffness);
    EXPECT_EQ(damping[i], system.materials[spring.kind].damping);
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
  EXPECT_FALSE(has_attribute(file_.get(), "/springs", "unit"));
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
