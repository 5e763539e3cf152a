#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "geometry/geometry.h"
#include "mesh/meshing.h"
#include "mesh/tet_mesh.h"
#include "tests/support/mesh_fixture.h"

namespace mssim {
namespace {

/// A body of Hong et al., Table 2: its published numbers (a third of the published springs) and the
/// parameters that a search found to give a mesh with exactly these.
struct Body {
  const char* name;
  std::size_t nodes, edges;
  std::int64_t euler_characteristic;
  Shape shape;
  InteriorPoints interior;
};

const std::array<Body, 9> bodies{{
    {"box_small", 700, 4307, 1, BoxShape{{0.13, 0.13, 0.13}, {7, 7, 7}}, {404, 1352, 0.1, 0.6}},
    {"box_medium", 1579, 10005, 1, BoxShape{{0.18, 0.18, 0.18}, {9, 10, 10}}, {1017, 710, 0.1, 0.65}},
    {"box_large", 2941, 19470, 1, BoxShape{{0.22, 0.22, 0.22}, {10, 10, 10}}, {2339, 1047, 0.08, 0.6}},
    {"sphere_small", 726, 4715, 1, SphereShape{0.09, 4}, {564, 1453, 0.1, 0.65}},
    {"sphere_medium", 1599, 10837, 1, SphereShape{0.12, 5}, {1347, 1061, 0.25, 0.65}},
    {"sphere_large", 3002, 20217, 1, SphereShape{0.145, 6}, {2640, 1182, 0.1, 0.6}},
    {"torus_small", 620, 3690, 0, TorusShape{0.105, 0.031, 30, 9}, {350, 1494, 0.1, 0.6}},
    {"torus_medium", 962, 5847, 0, TorusShape{0.12, 0.036, 36, 11}, {566, 114, 0.1, 0.6}},
    {"torus_large", 1977, 13011, 0, TorusShape{0.155, 0.05, 32, 11}, {1625, 1485, 0.16, 0.65}},
}};

void PrintTo(const Body& body, std::ostream* out) { *out << body.name; }

class TableTwoBody : public MeshTest, public testing::WithParamInterface<Body> {};

TEST_P(TableTwoBody, HasThePublishedNodesAndAThirdOfThePublishedSprings) {
  const Body& body = GetParam();
  const ShapePoints points = points_of(body.shape, body.interior);
  const TetMesh mesh = shape_mesh(body.shape, body.interior);
  EXPECT_EQ(mesh.nodes.size(), body.nodes);
  EXPECT_EQ(edges_of(mesh).size(), body.edges);
  EXPECT_EQ(euler_characteristic(mesh), body.euler_characteristic);
  EXPECT_FALSE(find_defect(mesh));
  EXPECT_NEAR(volume_of(mesh), volume_of(points.surface), 1e-9 * volume_of(points.surface));

  EXPECT_EQ(point_count(body.shape, body.interior), body.nodes);

  // The order of the nodes: surface points, then interior points.
  ASSERT_EQ(points.surface.points.size() + points.interior.size(), body.nodes);
  EXPECT_TRUE(std::equal(points.surface.points.begin(), points.surface.points.end(), mesh.nodes.begin()));
  EXPECT_TRUE(std::equal(points.interior.rbegin(), points.interior.rend(), mesh.nodes.rbegin()));
}

TEST_P(TableTwoBody, HasNoVeryShortEdgesAndNoVeryFlatTetrahedra) {
  const TetMesh mesh = shape_mesh(GetParam().shape, GetParam().interior);
  double shortest = 1;
  double sum = 0;
  const auto edges = edges_of(mesh);
  for (const auto& [a, b] : edges) {
    const double metres = length(mesh.nodes[a] - mesh.nodes[b]);
    shortest = std::min(shortest, metres);
    sum += metres;
  }
  const double mean = sum / static_cast<double>(edges.size());
  EXPECT_NEAR(mean, 0.02, 0.001);  // the same material in every body
  EXPECT_GT(shortest, 0.3 * mean);
  EXPECT_GT(smallest_dihedral_angle(mesh), 1.5);
}

TEST_P(TableTwoBody, HasNearlyTheVolumeOfItsShape) {
  struct Volume {
    double operator()(const BoxShape& box) const { return box.size.x * box.size.y * box.size.z; }
    double operator()(const SphereShape& sphere) const {
      return 4 * std::numbers::pi / 3 * sphere.radius_m * sphere.radius_m * sphere.radius_m;
    }
    double operator()(const TorusShape& torus) const {
      return 2 * std::numbers::pi * std::numbers::pi * torus.major_radius_m * torus.minor_radius_m *
             torus.minor_radius_m;
    }
  };
  const double volume = std::visit(Volume{}, GetParam().shape);
  const double meshed = volume_of(points_of(GetParam().shape, GetParam().interior).surface);
  EXPECT_LE(meshed, volume * (1 + 1e-9));
  EXPECT_GT(meshed, 0.9 * volume);
}

INSTANTIATE_TEST_SUITE_P(HongEtAl, TableTwoBody, testing::ValuesIn(bodies),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(ShapeMesh, OfMorePointsThanTetGenMeshesIsRefusedBeforeItIsMade) {
  const auto complaint = [](const Shape& shape, const InteriorPoints& interior) {
    return input_error_of([&] { shape_mesh(shape, interior); });
  };
  EXPECT_THAT(
      complaint(BoxShape{{1, 1, 1}, {1000, 1000, 1000}}, {5}),
      testing::StartsWith("its mesh would have 6000007 points or more, with which TetGen takes longer than"));
  EXPECT_THAT(complaint(SphereShape{1, 1000}, {}), testing::HasSubstr("10000002 points or more"));
  EXPECT_THAT(complaint(TorusShape{2, 1, 2000, 2001}, {}), testing::HasSubstr("4002000 points or more"));
}

}  // namespace
}  // namespace mssim
