#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "geometry/surface.h"
#include "output/pictures/painter.h"
#include "tests/support/cloth_system.h"
#include "tests/support/solid_system.h"

namespace mssim {
namespace {

Surface surface_of(const Skin& skin, const std::vector<Vec3d>& position) {
  Surface surface{{}, skin.triangles};
  for (const std::uint32_t node : skin.node) surface.points.push_back(position[node]);
  return surface;
}

TEST(Skin, OfAClothIsTwoTrianglesACell) {
  const System system = cloth_system(4, 6);
  const Skin skin = skin_of(system.topology, system.start.position);
  EXPECT_EQ(skin.node.size(), 24U);
  EXPECT_EQ(skin.triangles.size(), 2U * 3 * 5);
  EXPECT_EQ(skin.parts, std::vector<std::string>{"cloth"});
  std::set<std::uint32_t> used;
  for (const auto& triangle : skin.triangles) used.insert(triangle.begin(), triangle.end());
  EXPECT_EQ(used.size(), 24U);
}

TEST(Skin, OfBodiesClosesAroundThem) {
  const System system = solid_block(3, 4, 5);
  const Skin skin = skin_of(system.topology, system.start.position);
  double volume = 0;
  const auto& nodes = system.start.position;
  for (const auto& [a, b, c, d] : std::get<TetrahedralMesh>(system.topology).tetrahedra)
    volume += dot(nodes[b] - nodes[a], cross(nodes[c] - nodes[a], nodes[d] - nodes[a])) / 6;
  EXPECT_NEAR(volume_of(surface_of(skin, nodes)), volume, 1e-9 * volume);  // outwards, and whole
  // Every edge lies in two triangles, which run along it in opposite directions.
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const auto& triangle : skin.triangles)
    for (std::size_t i = 0; i < 3; ++i) ++edges[{skin.node[triangle[i]], skin.node[triangle[(i + 1) % 3]]}];
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    EXPECT_EQ(edges.count({edge.second, edge.first}), 1U);
  }
}

TEST(Skin, HasAPointForEachSideOfASharpEdge) {
  const System system = solid_block(2, 2, 2);
  const Skin skin = skin_of(system.topology, system.start.position);
  std::map<std::uint32_t, std::size_t> points;
  for (const std::uint32_t node : skin.node) ++points[node];
  std::map<std::size_t, std::size_t> nodes_with;
  for (const auto& [node, count] : points) ++nodes_with[count];
  EXPECT_EQ(nodes_with[3], 8U) << "corners of the block";
  EXPECT_EQ(skin.node.size(), 3U * 8 + 2 * nodes_with[2] + nodes_with[1]);
}

TEST(Skin, KeepsBodiesApart) {
  const System system = two_solid_blocks();
  const Skin skin = skin_of(system.topology, system.start.position);
  EXPECT_EQ(skin.parts, (std::vector<std::string>{"body 1", "body 2"}));
  for (std::size_t point = 0; point < skin.node.size(); ++point)
    EXPECT_EQ(skin.part[point], skin.node[point] < solid_block(4, 5, 3).nodes() ? 0U : 1U);
}

}  // namespace
}  // namespace mssim
