// Traces of tetrahedral bodies, and of what has been taken from the energy.
#include <array>
#include <utility>

#include "output/traces/xdmf.h"
#include "tests/support/solid_system.h"
#include "tests/support/trace_fixture.h"

namespace mssim {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class BodyTrace : public Trace {
 protected:
  void write_bodies(int frames) const {
    H5mdTrace trace(file(), bodies_, header());
    for (int frame = 0; frame < frames; ++frame) write_frame(trace, bodies_, frame);
    trace.close();
  }
  const System bodies_ = two_solid_blocks();
  const std::vector<Tetrahedron>& tetrahedra() const {
    return std::get<TetrahedralMesh>(bodies_.topology).tetrahedra;
  }
};

std::string group_of(hid_t file, const std::string& dataset) {
  const Hdf5Attribute group(
      H5Aopen_by_name(file, dataset.c_str(), "particles_group", H5P_DEFAULT, H5P_DEFAULT), "particles_group");
  hobj_ref_t reference{};
  H5Aread(group.get(), H5T_STD_REF_OBJ, &reference);
  std::array<char, 64> name{};
  H5Rget_name(file, H5R_OBJECT, &reference, name.data(), name.size());
  return name.data();
}

TEST_F(BodyTrace, HasItsNodesInTheSystemsOrderUnderBodies) {
  write_bodies(2);
  const Hdf5File h5 = open(file());
  std::vector<float> position, velocity;
  for (int frame = 0; frame < 2; ++frame) {
    const State state = state_at(bodies_, frame);
    std::ranges::copy(in_single_precision(state.position), std::back_inserter(position));
    std::ranges::copy(in_single_precision(state.velocity), std::back_inserter(velocity));
  }
  EXPECT_EQ(read<float>(h5.get(), "/particles/bodies/position/value", H5T_NATIVE_FLOAT), position);
  EXPECT_EQ(read<float>(h5.get(), "/particles/bodies/velocity/value", H5T_NATIVE_FLOAT), velocity);
  EXPECT_EQ(read<double>(h5.get(), "/particles/bodies/mass", H5T_NATIVE_DOUBLE), bodies_.node_mass);
  EXPECT_EQ(read<double>(h5.get(), "/observables/total_energy/time", H5T_NATIVE_DOUBLE),
            (std::vector<double>{0, 0.1}));
  EXPECT_EQ(H5Lexists(h5.get(), "/particles/cloth", H5P_DEFAULT), 0);
  for (const char* name : {"rows", "columns"})
    EXPECT_EQ(H5Aexists_by_name(h5.get(), "/parameters", name, H5P_DEFAULT), 0) << name;
}

TEST_F(BodyTrace, ListsSpringsAndTetrahedra) {
  write_bodies(0);
  const Hdf5File h5 = open(file());
  const auto corners = read<std::uint32_t>(h5.get(), "/connectivity/tetrahedra", H5T_NATIVE_UINT32);
  EXPECT_EQ(shape_of(h5.get(), "/connectivity/tetrahedra"), (std::vector<hsize_t>{tetrahedra().size(), 4}));
  for (std::size_t t = 0; t < tetrahedra().size(); ++t)
    EXPECT_TRUE(std::ranges::equal(tetrahedra()[t], std::span(corners).subspan(4 * t, 4))) << t;
  const auto ends = read<std::uint32_t>(h5.get(), "/connectivity/springs", H5T_NATIVE_UINT32);
  ASSERT_EQ(ends.size(), 2 * bodies_.springs.size());
  EXPECT_EQ(ends.back(), bodies_.springs.back().second);
  EXPECT_EQ(group_of(h5.get(), "/connectivity/tetrahedra"), "/particles/bodies");
  EXPECT_EQ(group_of(h5.get(), "/connectivity/springs"), "/particles/bodies");
}

TEST_F(BodyTrace, ShowsSolidsToXdmfReaders) {
  write_bodies(3);
  const std::string xdmf = text_of(folder() / "run.xdmf");
  const std::string nodes = std::to_string(bodies_.nodes()), count = std::to_string(tetrahedra().size());
  EXPECT_THAT(xdmf,
              AllOf(HasSubstr("<Topology TopologyType=\"Tetrahedron\" NumberOfElements=\"" + count + "\">"),
                    HasSubstr("<DataItem Dimensions=\"" + count +
                              " 4\" NumberType=\"UInt\" Precision=\"4\" "
                              "Format=\"HDF\">run.h5:/connectivity/tetrahedra</DataItem>"),
                    HasSubstr("<DataItem Dimensions=\"" + nodes +
                              " 3\" NumberType=\"Float\" Precision=\"4\" "
                              "Format=\"HDF\">run.h5:/xdmf/velocity/000002</DataItem>"),
                    Not(HasSubstr("000003")), Not(HasSubstr("3DSMesh"))));
  const Hdf5File h5 = open(file());
  for (int frame = 0; frame < 3; ++frame) {
    const std::string path =
        xdmf_dataset("position", xdmf_mesh_of(bodies_, {}).parts.front(), static_cast<std::size_t>(frame));
    EXPECT_EQ(shape_of(h5.get(), path), (std::vector<hsize_t>{bodies_.nodes(), 3}));
    EXPECT_EQ(read<float>(h5.get(), path, H5T_NATIVE_FLOAT),
              in_single_precision(state_at(bodies_, frame).position));
  }
}

TEST_F(BodyTrace, KeepsItsFramesWhenItIsGivenUp) {
  {
    H5mdTrace trace(file(), bodies_, header());
    write_frame(trace, bodies_, 0);
  }
  const Hdf5File h5 = open(part());
  EXPECT_EQ(shape_of(h5.get(), "/particles/bodies/position/value"),
            (std::vector<hsize_t>{1, bodies_.nodes(), 3}));
}

TEST_F(BodyTrace, RefusesTetrahedraThatAreMissingOrPointBeyondTheNodes) {
  System system = bodies_;
  std::get<TetrahedralMesh>(system.topology).tetrahedra.back()[2] =
      static_cast<std::uint32_t>(system.nodes());
  EXPECT_THROW(H5mdTrace(file(), system, header()), std::invalid_argument);
  system.topology = TetrahedralMesh{};
  EXPECT_THROW(H5mdTrace(file(), system, header()), std::invalid_argument);
  system.topology = GridPatch{3, 5, 0.01};
  EXPECT_THROW(H5mdTrace(file(), system, header()), std::invalid_argument);
  EXPECT_TRUE(std::filesystem::is_empty(folder()));
}

TEST_F(Trace, CarriesLossesBesideTheEnergiesWhenItsHeaderSaysSo) {
  TraceHeader with_losses = header();
  with_losses.with_losses = true;
  {
    H5mdTrace trace(file(), system_, with_losses);
    for (int frame = 0; frame < 2; ++frame)
      trace.write_frame(frame, frame, state_at(system_, frame), energy_at(frame),
                        EnergyLosses{1. * frame, 2. * frame, 3. * frame, -4. * frame});
    trace.close();
  }
  const Hdf5File h5 = open(file());
  const auto address = [&](const std::string& path) {
    H5O_info_t info{};
    checked(H5Oget_info_by_name(h5.get(), path.c_str(), &info, H5P_DEFAULT), path);
    return info.addr;
  };
  for (const auto& [name, value] :
       {std::pair{"damping", 1.}, {"friction", 2.}, {"bounce", 3.}, {"integration", -4.}}) {
    const std::string path = std::string("/observables/") + name + "_loss";
    EXPECT_EQ(read<double>(h5.get(), path + "/value", H5T_NATIVE_DOUBLE), (std::vector<double>{0, value}));
    EXPECT_EQ(address(path + "/step"), address("/particles/cloth/position/step"));
    EXPECT_EQ(address(path + "/time"), address("/particles/cloth/position/time"));
  }
  EXPECT_EQ(read<double>(h5.get(), "/observables/total_energy/value", H5T_NATIVE_DOUBLE),
            (std::vector<double>{energy_at(0).total(), energy_at(1).total()}));
}

TEST_F(Trace, RefusesFramesWithLossesWhereItsHeaderHasNoneAndTheOtherWayRound) {
  H5mdTrace without(file(), system_, header());
  EXPECT_THROW(without.write_frame(0, 0, state_at(system_, 0), {}, EnergyLosses{}), std::invalid_argument);
  TraceHeader with_losses = header();
  with_losses.with_losses = true;
  H5mdTrace with(folder() / "other.h5", system_, with_losses);
  EXPECT_THROW(with.write_frame(0, 0, state_at(system_, 0), {}), std::invalid_argument);
  without.close();
  const Hdf5File h5 = open(file());
  EXPECT_EQ(H5Lexists(h5.get(), "/observables/damping_loss", H5P_DEFAULT), 0);
}

}  // namespace
}  // namespace mssim
