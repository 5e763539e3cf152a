#include "garment/contact/solid.h"

#include <omp.h>

#include "garment/body/mannequin.h"
#include "mesh/meshing.h"
#include "tests/support/contact_fixture.h"
#include "tests/support/mesh_fixture.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

Surface moved(Surface surface, const Vec3d& by) {
  for (Vec3d& point : surface.points) point += by;
  return surface;
}

double depth_in_unit_cube(const Vec3d& p) {
  return std::max(0.0, std::min({p.x, 1 - p.x, p.y, 1 - p.y, p.z, 1 - p.z}));
}

double distance_from_unit_cube(const Vec3d& p) {
  if (depth_in_unit_cube(p) > 0) return depth_in_unit_cube(p);
  const auto beyond = [](double x) { return std::max({-x, x - 1, 0.0}); };
  return length(Vec3d{beyond(p.x), beyond(p.y), beyond(p.z)});
}

TEST(Solid, ACubeIsExactOnALatticeThatMeetsItsFacesEdgesAndVertices) {
  // Every ray along x through such a point runs in faces, through edges or through diagonals of the faces.
  const Solid cube(unit_cube());
  for (int i = -4; i <= 12; ++i)
    for (int j = -4; j <= 12; ++j)
      for (int k = -4; k <= 12; ++k) {
        const Vec3d p{i / 8.0, j / 8.0, k / 8.0};
        EXPECT_NEAR(cube.depth(p), depth_in_unit_cube(p), 1e-15) << i << " " << j << " " << k;
        EXPECT_NEAR(cube.distance(p), distance_from_unit_cube(p), 1e-15) << i << " " << j << " " << k;
      }
}

TEST(Solid, ACubeIsExactNearItsFacesEdgesAndVertices) {
  const Solid cube(unit_cube());
  for (const double by : {1e-15, 1e-12, 1e-9, 1e-6})
    for (int i = -1; i <= 1; ++i)
      for (int j = -1; j <= 1; ++j)
        for (int k = -1; k <= 1; ++k)
          for (const Vec3d& at : {Vec3d{0, 0, 0}, Vec3d{1, 0.5, 0}, Vec3d{0.5, 0.5, 1}, Vec3d{1, 1, 1}}) {
            const Vec3d p = at + by * Vec3d{double(i), double(j), double(k)};
            EXPECT_NEAR(cube.depth(p), depth_in_unit_cube(p), 1e-16);
            EXPECT_NEAR(cube.distance(p), distance_from_unit_cube(p), 3e-16);
          }
}

TEST(Solid, ATurnedCubeIsExact) {
  // Turned about two axes, so that no face is seen edge-on; points in its faces' planes stay special.
  const double c = 0.8, s = 0.6;
  const auto turned = [&](const Vec3d& p) {
    const Vec3d q{c * p.x - s * p.y, s * p.x + c * p.y, p.z};
    return Vec3d{c * q.x + s * q.z, q.y, -s * q.x + c * q.z};
  };
  Surface surface = unit_cube();
  for (Vec3d& point : surface.points) point = turned(point);
  const Solid cube(surface);
  for (int i = -2; i <= 6; ++i)
    for (int j = -2; j <= 6; ++j)
      for (int k = -2; k <= 6; ++k) {
        const Vec3d p{i / 4.0, j / 4.0, k / 4.0};
        EXPECT_NEAR(cube.depth(turned(p)), depth_in_unit_cube(p), 1e-15) << i << " " << j << " " << k;
        EXPECT_NEAR(cube.distance(turned(p)), distance_from_unit_cube(p), 1e-15) << i << " " << j << " " << k;
      }
}

TEST(Solid, ASphereIsAsDeepAsTheShellOfItsTrianglesAllows) {
  const SphereShape shape{0.5, 12};
  const Surface surface = surface_of(shape);
  // The mesh lies between the sphere and the sphere that touches its triangles from inside.
  const double inner = enclosed_radius(surface);
  ASSERT_GT(inner, 0.99 * shape.radius_m);
  const Solid sphere(surface);
  RandomPoints random;
  for (int i = 0; i < 2000; ++i) {
    const Vec3d p = random.point(-0.6, 0.6);
    const double depth = sphere.depth(p);
    EXPECT_LE(depth, std::max(0.0, shape.radius_m - length(p)) + 1e-6) << i;  // points are in micrometres
    EXPECT_GE(depth, inner - length(p) - 1e-6) << i;
    EXPECT_GE(sphere.distance(p), length(p) - shape.radius_m - 1e-6) << i;
    EXPECT_LE(sphere.distance(p), std::abs(length(p) - inner) + shape.radius_m - inner + 1e-6) << i;
  }
  for (const Vec3d& vertex : surface.points) {  // on it, and on the ray through it and the centre
    EXPECT_NEAR(sphere.depth(vertex), 0, 1e-15);
    EXPECT_EQ(sphere.depth(1.0001 * vertex), 0);
    EXPECT_NEAR(sphere.depth(0.9999 * vertex), 0.0001 * 0.5, 0.02 * 0.0001);
  }
}

TEST(Solid, TwoCubesThatOverlapAreTheirUnion) {
  const Solid cubes(both(unit_cube(), unit_cube({0.5, 0.25, 0.125})));
  RandomPoints random;
  int in_both = 0;
  for (int i = 0; i < 3000; ++i) {
    const Vec3d p = random.point(-0.25, 1.75);
    const double first = depth_in_unit_cube(p), second = depth_in_unit_cube(p - Vec3d{0.5, 0.25, 0.125});
    in_both += first > 0 && second > 0;
    EXPECT_NEAR(cubes.depth(p), std::max(first, second), 1e-15);
    EXPECT_NEAR(cubes.distance(p),
                std::min(distance_from_unit_cube(p), distance_from_unit_cube(p - Vec3d{0.5, 0.25, 0.125})),
                1e-15);
  }
  EXPECT_GT(in_both, 50);
}

TEST(Solid, APartThatPointsInwardsIsSolidAllTheSame) {
  Surface small = moved(unit_cube(), {3, 0, 0});
  for (Vec3d& point : small.points) point = {point.x, 0.5 * point.y, point.z};
  for (auto& triangle : small.triangles) std::swap(triangle[0], triangle[1]);
  const Surface surface = both(unit_cube(), small);
  EXPECT_DOUBLE_EQ(Solid(surface).depth({3.5, 0.25, 0.5}), 0.25);
  const std::vector<Surface> parts = closed_parts(surface);
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_NEAR(volume_of(parts[0]), 1, 1e-12);
  EXPECT_NEAR(volume_of(parts[1]), 0.5, 1e-12);
}

/// A sphere with random dents and spikes, thin and steep: star-shaped, so that it is closed and does not
/// cross itself, and a point's side is known from the triangle that its direction meets.
Surface spiky() {
  Surface surface = surface_of(SphereShape{1, 7});
  RandomPoints random;
  for (Vec3d& point : surface.points) point = random.number(0.4, 1.6) * point;
  return surface;
}

/// Another way than the tree's: the distance from a + u ab + v ac is convex; its least over v is known for
/// each u, and golden sections find the least over u.
double slow_distance(const std::array<Vec3d, 3>& t, const Vec3d& p) {
  const Vec3d ab = t[1] - t[0], ac = t[2] - t[0];
  const auto at = [&](double u) {
    const Vec3d from = t[0] + u * ab - p;
    const double v = std::clamp(-dot(from, ac) / dot(ac, ac), 0.0, 1 - u);
    return length(from + v * ac);
  };
  double low = 0, high = 1;
  for (int i = 0; i < 90; ++i) {
    const double step = (high - low) / (std::numbers::phi + 1);
    if (at(low + step) < at(high - step))
      high -= step;
    else
      low += step;
  }
  return std::min({at(0), at(1), at((low + high) / 2)});
}

TEST(Solid, ARandomMeshAgreesWithBruteForceInAnyOrder) {
  const Surface surface = spiky();
  const Solid solid(surface), again(shuffled(surface));
  RandomPoints random;
  int inside = 0;
  for (int i = 0; i < 250; ++i) {
    const Vec3d p = random.point(-1.3, 1.3);
    double least = HUGE_VAL;
    bool is_inside = false;
    for (const auto& [i0, i1, i2] : surface.triangles) {
      const Vec3d &a = surface.points[i0], &b = surface.points[i1], &c = surface.points[i2];
      least = std::min(least, slow_distance({a, b, c}, p));
      // p is a positive combination of the corners of the triangle that its direction meets.
      if (dot(p, cross(a, b)) > 0 && dot(p, cross(b, c)) > 0 && dot(p, cross(c, a)) > 0)
        is_inside = dot(p - a, cross(b - a, c - a)) < 0;
    }
    inside += is_inside;
    EXPECT_NEAR(solid.distance(p), least, 1e-7) << i;
    EXPECT_NEAR(solid.depth(p), is_inside ? least : 0, 1e-7) << i;
    EXPECT_NEAR(again.distance(p), solid.distance(p), 1e-14) << i;
    EXPECT_NEAR(again.depth(p), solid.depth(p), 1e-14) << i;
  }
  EXPECT_GT(inside, 20);
  EXPECT_LT(inside, 230);
}

TEST(Solid, RayAndSolidAnglesAgree) {
  const TriangleTree tree(spiky());
  RandomPoints random;
  for (int i = 0; i < 300; ++i) {
    const Vec3d p = random.point(-1.3, 1.3);
    ASSERT_TRUE(tree.winding_by_ray(p)) << i;
    EXPECT_EQ(*tree.winding_by_ray(p), tree.winding_by_angles(p)) << i;
  }
  // Where a ray cannot tell, because it meets an edge or runs along a face, it says so.
  const TriangleTree cube(unit_cube());
  EXPECT_EQ(cube.winding_by_ray({0.5, 0.5, 0.5}), std::nullopt);
  EXPECT_EQ(cube.winding_by_ray({0.5, 1, 0.25}), std::nullopt);
  EXPECT_EQ(cube.winding_by_ray({0.5, 0.5, 0.25}), 1);
  EXPECT_EQ(cube.winding_by_angles({0.5, 0.5, 0.5}), 1);
  EXPECT_EQ(cube.winding_by_angles({0.5, 1.5, 0.25}), 0);
}

TEST(Solid, ThreadsDoNotMatter) {
  const Solid solid(spiky());
  RandomPoints random;
  std::vector<Vec3d> points(3000);
  for (Vec3d& point : points) point = random.point(-1.2, 1.2);
  points.push_back({std::numeric_limits<double>::quiet_NaN(), 0, 0});
  const std::vector<double> usual = solid.depths(points);
  ASSERT_EQ(usual.size(), points.size());
  EXPECT_EQ(usual.back(), 0);
  EXPECT_EQ(usual[5], solid.depth(points[5]));
  const int usual_threads = omp_get_max_threads();
  for (const int threads : {1, 2, 3}) {
    omp_set_num_threads(threads);
    EXPECT_EQ(solid.depths(points), usual) << threads;
  }
  omp_set_num_threads(usual_threads);
  EXPECT_TRUE(solid.depths({}).empty());
}

TEST(Solid, AnOpenSurfaceIsRefused) {
  Surface open = unit_cube();
  open.triangles.pop_back();
  EXPECT_THAT(sentence_of<InputError>([&] { Solid{open}; }), StartsWith("the body: the edge from"));
}

// How far points lie outside of a body whose hollows are bridged.

/// A round tube of 0.1 m from 0 to 1 m with a waist of 0.06 m at 0.5 m.
Surface waisted_tube() {
  Surface surface;
  add_tube(surface,
           {{0, -0.1, 0.1, -0.1, 0.1},
            {0.4, -0.1, 0.1, -0.1, 0.1},
            {0.5, -0.06, 0.06, -0.06, 0.06},
            {0.6, -0.1, 0.1, -0.1, 0.1},
            {1, -0.1, 0.1, -0.1, 0.1}},
           180, 0.02);
  return surface;
}

TEST(BandHull, BridgesHollowsBetweenItsHeights) {
  const BandHull whole(waisted_tube(), 0.2, 0.8);
  EXPECT_NEAR(whole.distance({0.11, 0.5, 0}), 0.01, 1e-4);
  EXPECT_NEAR(whole.distance({0, 0.3, -0.13}), 0.03, 1e-4);
  EXPECT_EQ(whole.distance({0.09, 0.5, 0}), 0) << "in the hollow";
  const BandHull waist(waisted_tube(), 0.499, 0.501);
  EXPECT_NEAR(waist.distance({0.11, 0.5, 0}), 0.05, 1e-3) << "which is no hollow of so low a band";
}

}  // namespace
}  // namespace mssim
