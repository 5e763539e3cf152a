#include "output/exports/exports.h"

#include <gtest/gtest.h>

#include <cstring>
#include <sstream>

#include "tests/support/systems.h"
#include "tests/support/trace_fixture.h"
#include "tests/support/trace_systems.h"

namespace mssim {
namespace {

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

/// What a small reader of OBJ finds.
struct ObjContent {
  std::vector<Vec3d> points;
  Triangles triangles;
  std::vector<std::string> objects;
};

ObjContent content_of_obj(const std::string& text) {
  ObjContent content;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line.substr(1));
    if (line[0] == 'v') {
      Vec3d& point = content.points.emplace_back();
      words >> point.x >> point.y >> point.z;
    } else if (line[0] == 'f') {
      auto& [a, b, c] = content.triangles.emplace_back();
      words >> a >> b >> c;
      --a, --b, --c;
    } else if (line[0] == 'o') {
      content.objects.push_back(line.substr(2));
    }
    EXPECT_FALSE(words.fail()) << line;
  }
  return content;
}

template <class Number>
Number number_at(const std::string& bytes, std::size_t& at) {
  Number number{};
  std::memcpy(&number, bytes.data() + at, sizeof number);
  at += sizeof number;
  return number;
}

class Exports : public Trace {
 protected:
  TraceReader trace_of(const System& system, bool in_double, const Surface& body = {}) const {
    TraceHeader head = header();
    head.in_double = in_double;
    H5mdTrace trace(file(), system, head, body);
    for (int frame = 0; frame < 3; ++frame) write_frame(trace, system, frame);
    trace.close();
    return TraceReader(file());
  }

  /// Expects the bytes of a PLY to hold a frame; `Number` is what its coordinates are.
  template <class Number>
  static void expect_ply(const std::string& bytes, const ExportMesh& mesh, const ExportFrame& frame) {
    const std::string end = "end_header\n";
    std::size_t at = bytes.find(end) + end.size();
    for (std::size_t i = 0; i < mesh.node.size(); ++i) {
      const Vec3d &x = frame.position[i], &v = frame.velocity[i];
      for (const double number : {x.x, x.y, x.z, v.x, v.y, v.z, frame.strain[i]})
        EXPECT_EQ(number_at<Number>(bytes, at), static_cast<Number>(number));
      EXPECT_EQ(number_at<std::int32_t>(bytes, at), mesh.node[i]);
      EXPECT_EQ(number_at<std::int32_t>(bytes, at), mesh.part[i]);
    }
    for (const auto& triangle : mesh.triangles) {
      EXPECT_EQ(number_at<std::uint8_t>(bytes, at), 3);
      for (const std::uint32_t point : triangle) EXPECT_EQ(number_at<std::uint32_t>(bytes, at), point);
    }
    EXPECT_EQ(at, bytes.size());
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
  EXPECT_EQ(content_of_obj(obj_of(mesh, frame)).objects,
            (std::vector<std::string>{"front \"left\" & more", "back", "person"}));
}

TEST_F(Exports, AreReadBackFromObj) {
  for (const bool in_double : {false, true}) {
    const TraceReader trace = trace_of(system_, in_double);
    const ExportMesh mesh = surface_mesh(trace.content());
    const ExportFrame frame = frame_of(trace, mesh, 2);
    const ObjContent content = content_of_obj(obj_of(mesh, frame));
    EXPECT_EQ(in_single_precision(content.points), in_single_precision(frame.position));
    if (in_double) {
      EXPECT_EQ(content.points, frame.position);
    }
    EXPECT_EQ(content.triangles, mesh.triangles);
    EXPECT_EQ(content.objects, std::vector<std::string>{"cloth"});
  }
}

TEST_F(Exports, AreReadBackFromPly) {
  for (const bool in_double : {false, true}) {
    const TraceReader trace = trace_of(system_, in_double);
    const ExportMesh mesh = surface_mesh(trace.content());
    const ExportFrame frame = frame_of(trace, mesh, 2);
    const std::string bytes = ply_of(mesh, frame);
    if (in_double)
      expect_ply<double>(bytes, mesh, frame);
    else
      expect_ply<float>(bytes, mesh, frame);
    EXPECT_NE(bytes.find("\ncomment part 0: cloth\nelement vertex 20\n"), std::string::npos);
    EXPECT_NE(bytes.find("\nelement face 24\n"), std::string::npos);
  }
}

TEST_F(Exports, AreReadBackFromVtkhdf) {
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
  const Hdf5File file = open(exported);
  const auto integers = [&](const std::string& path) {
    return read<std::int64_t>(file.get(), "/VTKHDF/" + path, H5T_NATIVE_INT64);
  };
  const auto doubles = [&](const std::string& path) {
    return read<double>(file.get(), "/VTKHDF/" + path, H5T_NATIVE_DOUBLE);
  };
  EXPECT_EQ(shape_of(file.get(), "/VTKHDF/Points"), (std::vector<hsize_t>{2 * 20, 3}));
  const std::vector<double> points = doubles("Points"), velocity = doubles("PointData/velocity");
  for (std::size_t i = 0; i < 20; ++i) {
    EXPECT_EQ(points[3 * i + 1], state_at(system_, 0).position[i].y);
    EXPECT_EQ(points[60 + 3 * i + 2], state_at(system_, 2).position[i].z);
    EXPECT_EQ(velocity[60 + 3 * i], state_at(system_, 2).velocity[i].x);
  }
  EXPECT_EQ(doubles("Steps/Values"), (std::vector<double>{0, 0.1 * 2}));
  EXPECT_EQ(integers("Steps/PointOffsets"), (std::vector<std::int64_t>{0, 20}));
  EXPECT_EQ(integers("Steps/PointDataOffsets/strain"), (std::vector<std::int64_t>{0, 20}));
  EXPECT_EQ(integers("Steps/PointDataOffsets/node"), (std::vector<std::int64_t>{0, 0}));
  EXPECT_EQ(shape_of(file.get(), "/VTKHDF/Steps/CellOffsets"), (std::vector<hsize_t>{2, 1}));
  EXPECT_EQ(integers("NumberOfCells"), std::vector<std::int64_t>{24});
  EXPECT_EQ(integers("Offsets").back(), 3 * 24);
  EXPECT_EQ(integers("Connectivity")[1], mesh.triangles[0][1]);
}

}  // namespace
}  // namespace mssim
