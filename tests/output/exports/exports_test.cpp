#include "output/exports/exports.h"

#include "tests/support/systems.h"
#include "tests/support/testing.h"
#include "tests/support/trace_fixture.h"
#include "tests/support/trace_systems.h"

namespace mssim {
namespace {

class Exports : public Trace {
 protected:
  TraceReader trace_of(const System& system, bool in_double, const Surface& body = {}) const {
    write(system, 3, body, in_double);
    return TraceReader(file());
  }
};

TEST_F(Exports, ShowTheOutsideOfBodies) {
  const System system = two_solid_blocks();
  const ExportMesh mesh = surface_mesh(trace_of(system, false).content());
  EXPECT_EQ(mesh.parts, (std::vector<std::string>{"body 1", "body 2"}));
  EXPECT_EQ(mesh.node.size(), system.nodes() - 2 * 3 * 1 - 1 * 1 * 5) << "but for the inner nodes";
  EXPECT_TRUE(mesh.tetrahedra.empty());
  const ExportMesh solid = solid_mesh(trace_of(system, false).content());
  EXPECT_EQ(solid.node.size(), system.nodes());
  EXPECT_EQ(solid.tetrahedra, std::get<TetrahedralMesh>(system.topology).tetrahedra);
  EXPECT_TRUE(solid.triangles.empty());
  for (std::size_t node = 0; node < system.nodes(); ++node)
    EXPECT_EQ(solid.part[node], node < solid_block(4, 5, 3).nodes() ? 0 : 1);
}

TEST_F(Exports, ShowTheBodyBehindTheGarment) {
  const System system = two_panels();
  const Surface body = small_tetrahedron();
  const TraceReader trace = trace_of(system, true, body);
  const ExportMesh mesh = surface_mesh(trace.content());
  const ExportFrame frame = frame_of(trace, mesh, 1);
  ASSERT_EQ(frame.position.size(), system.nodes() + 4);
  EXPECT_EQ(mesh.triangles.size(), 2U * (2 * 3 + 1 * 4) + 4);
  EXPECT_EQ(mesh.triangles.back(), (std::array<std::uint32_t, 3>{23, 24, 25}));
  for (std::size_t point = 22; point < 26; ++point) {
    EXPECT_EQ(mesh.node[point], -1);
    EXPECT_EQ(mesh.part[point], -1);
    EXPECT_EQ(frame.velocity[point], Vec3d{});
  }
  EXPECT_EQ(mesh.part[11], 0);
  EXPECT_EQ(mesh.part[12], 1);
  EXPECT_EQ(frame.position[5], state_at(system, 1).position[5]);
  const std::string obj = obj_of(mesh, frame);
  for (const char* object : {"\no front \"left\" & more\n", "\no back\n", "\no person\n"})
    EXPECT_THAT(obj, testing::HasSubstr(object));
}

// What VTK and meshio read of all three formats: tests/commands/exports.py.
TEST_F(Exports, StandUnderTheirNameWhenTheyAreWhole) {
  const TraceReader trace = trace_of(system_, true);
  const ExportMesh mesh = solid_mesh(trace.content());
  const auto exported = folder() / "run.vtkhdf";
  {
    VtkhdfExport given_up(exported, mesh);
    given_up.add(frame_of(trace, mesh, 0));
  }
  EXPECT_FALSE(std::filesystem::exists(exported) || std::filesystem::exists(temporary_of(exported)));
  VtkhdfExport writer(exported, mesh);
  for (const std::size_t frame : {0U, 2U}) writer.add(frame_of(trace, mesh, frame));
  EXPECT_FALSE(std::filesystem::exists(exported));
  writer.close();
  EXPECT_FALSE(std::filesystem::exists(temporary_of(exported)));
}

}  // namespace
}  // namespace mssim
