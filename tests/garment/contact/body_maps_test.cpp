// How points stand to a body, as its maps have it.
#include "garment/contact/body_maps.h"

#include <omp.h>

#include <bit>

#include "garment/contact/solid.h"
#include "geometry/surface.h"
#include "mesh/meshing.h"
#include "tests/support/contact_fixture.h"
#include "tests/support/mesh_fixture.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

constexpr double micrometre = 1e-6;  ///< to which the shapes' points are rounded
constexpr double pixel = 0.0025;

/// The sphere around the origin that a mesh approximates, and how well.
struct MeshOfSphere {
  double radius;
  double shell;  ///< m, how far inside the sphere the mesh reaches
  /// Largest angle between a triangle's normal and the sphere's at its corners: the corners lie on the circle
  /// that the triangle's plane cuts out.
  double angle;

  MeshOfSphere(const Surface& mesh, double radius_)
      : radius(radius_), shell(radius - enclosed_radius(mesh)), angle(std::acos(1 - shell / radius)) {}
  /// Between the sphere's normal at a point of the mesh and the interpolated one: the point's direction, the
  /// triangle's normal, its corners' directions and the normals of the triangles around those, whose positive
  /// combination it is, are at most `angle` apart each.
  double normal_error() const { return 3 * angle; }
};

double angle_between(const Vec3d& a, const Vec3d& b) { return std::atan2(length(cross(a, b)), dot(a, b)); }

template <class Value>
bool same_bits(const Value& a, const Value& b) {
  using Words = std::array<std::uint32_t, sizeof(Value) / sizeof(std::uint32_t)>;
  return std::bit_cast<Words>(a) == std::bit_cast<Words>(b);
}

bool same_bits(const BodyMaps& a, const BodyMaps& b) {
  return same_bits(a.frame(), b.frame()) &&
         std::equal(a.pixels().begin(), a.pixels().end(), b.pixels().begin(), b.pixels().end(),
                    [](const BodyPixel& p, const BodyPixel& q) { return same_bits(p, q); });
}

/// How far from the sphere a point of its surroundings may be measured by the planes of its pixel. With exact
/// planes: for a plane that is tangent in P, |q| - n . q = (|q - P|^2 - (|q| - R)^2) / 2R, always too near.
/// A mesh changes the plane by its normals' error and by its shell seen along z.
struct DistanceBounds {
  double low = 0, high = 0;
};
DistanceBounds bounds(const MeshOfSphere& mesh, const Vec3d& q, const Vec3d& p) {
  const double d = length(q) - mesh.radius, apart = length(q - p);
  const double normals = mesh.normal_error() * apart;
  const double depth = 2 * mesh.shell + mesh.normal_error() * std::sqrt(2 * mesh.radius * mesh.shell);
  const double rounding = 1e-6;  // of single precision, and of the mesh's points
  const double curvature = (apart * apart - d * d) / (2 * mesh.radius);
  return {d - curvature - normals - depth - rounding, d + normals + depth + rounding};
}

/// The centre of the pixel of the maps that the point is in.
Vec3d centre_of_pixel(const BodyFrame& frame, const Vec3d& q) {
  const double size = 1 / static_cast<double>(frame.pixels_per_metre);
  const auto centre = [&](double x, double first) {
    return first + (std::floor((x - first) / size) + 0.5) * size;
  };
  return {centre(q.x, double{frame.left}), centre(q.y, double{frame.bottom}), 0};
}

void expect_maps_of_sphere(const BodyMaps& maps, const MeshOfSphere& mesh) {
  RandomPoints random;
  int tested = 0, good = 0;
  for (int i = 0; i < 20000; ++i) {
    const double d = random.number(-0.005, 0.005);
    const Vec3d q = (mesh.radius + d) * random.direction();
    Vec3d p = centre_of_pixel(maps.frame(), q);
    const double left = mesh.radius * mesh.radius - p.x * p.x - p.y * p.y;
    // Not where the plane leans to the camera, and not where the centre may be beside the mesh.
    if (left < std::pow(0.12 * mesh.radius, 2) + 2 * mesh.radius * mesh.shell) continue;
    p.z = std::copysign(std::sqrt(left), q.z);
    const DistanceBounds allowed = bounds(mesh, q, p);
    const auto contact = maps.contact(q.x, q.y, q.z);
    EXPECT_GE(contact.distance, allowed.low);
    EXPECT_LE(contact.distance, allowed.high);
    ++tested;
    if (allowed.high - allowed.low > 0.0006) continue;
    // Most of the sphere: the normal is that of the near side.
    ++good;
    EXPECT_LE(angle_between({contact.x, contact.y, contact.z}, p), mesh.normal_error() + 1e-6);
    const auto single =
        maps.contact(static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z));
    const Vec3d moved = centre_of_pixel(maps.frame(), {static_cast<float>(q.x), static_cast<float>(q.y), 0});
    if (moved.x == p.x && moved.y == p.y) {
      EXPECT_NEAR(single.distance, contact.distance, 1e-6);
    }
  }
  EXPECT_GT(tested, 15000);
  EXPECT_GT(good, 6000);
}

TEST(BodyMaps, TheDistanceFromASphereIsThatOfTangentPlanes) {
  const Surface surface = surface_of(SphereShape{0.15, 50});
  expect_maps_of_sphere(BodyMaps(surface, {.pixel = pixel}), MeshOfSphere(surface, 0.15));
}

TEST(BodyMaps, TheOffsetMovesTheSurfaceOutwards) {
  const Surface surface = surface_of(SphereShape{0.13, 50});
  const Surface larger = inflated(surface, vertex_normals(surface), 0.02);
  expect_maps_of_sphere(BodyMaps(surface, {.pixel = pixel, .offset = 0.02}), MeshOfSphere(larger, 0.15));
  // Flat faces move by exactly the offset.
  const BodyMaps box(surface_of(BoxShape{{1, 1, 1}, {4, 4, 4}}), {.pixel = 0.01, .offset = 0.125});
  for (const double x : {-0.2, 0.0, 0.1})
    for (const double y : {-0.15, 0.0, 0.2}) {
      EXPECT_NEAR(box.contact(x, y, 0.7).distance, 0.7 - 0.625, 1e-7);
      EXPECT_NEAR(box.contact(x, y, 0.6).distance, 0.6 - 0.625, 1e-7);
      EXPECT_NEAR(box.contact(x, y, -0.65).distance, 0.65 - 0.625, 1e-7);
      EXPECT_EQ(box.contact(x, y, 0.7).z, 1);
      EXPECT_EQ(box.contact(x, y, -0.7).z, -1);
    }
}

TEST(BodyMaps, AgreeWithTheSolidOnWhatIsInside) {
  const Surface surface = both(surface_of(SphereShape{0.12, 30}), [] {
    Surface other = surface_of(SphereShape{0.08, 30});
    for (Vec3d& point : other.points) point += Vec3d{0.09, 0.03, 0.04};
    for (auto& triangle : other.triangles)
      std::swap(triangle[0], triangle[1]);  // inwards: it is turned round
    return other;
  }());
  const Solid solid(surface);
  const BodyMaps maps(surface, {.pixel = pixel});
  RandomPoints random;
  int inside = 0, outside = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3d p = random.point(-0.2, 0.2);
    // A tangent plane leaves a sphere by s^2 R / 2 z^2 at the distance s from its pixel's centre, where P is
    // z high. That is 2 mm in the pixel itself where the plane is least inclined (z = R / 10). From a pixel
    // to those that repeat it s is up to 2.5 diagonals, but front and back plane exclude what has s > z^2 /
    // R: half of s, less than 1.8 pixels.
    const double most = 2 * pixel;
    if (solid.distance(p) < most) continue;
    const bool is_inside = solid.depth(p) > 0;
    ++(is_inside ? inside : outside);
    EXPECT_EQ(maps.contact(p.x, p.y, p.z).distance < 0, is_inside) << p.x << " " << p.y << " " << p.z;
  }
  EXPECT_GT(inside, 1500);
  EXPECT_GT(outside, 10000);
}

TEST(BodyMaps, WhatIsFarBeforeOrBehindTheBodyIsOutsideAtEverySilhouette) {
  // Coarse, so that normals interpolated near the silhouette point away from the camera.
  const BodyMaps maps(surface_of(SphereShape{0.1, 2}), {.pixel = 0.0005});
  const BodyFrame& frame = maps.frame();
  int with_body = 0;
  for (int row = 0; row <= 4 * frame.rows; ++row)
    for (int column = 0; column <= 4 * frame.columns; ++column)
      for (const double z : {0.4, -0.4}) {
        const auto contact = maps.contact(frame.left + column * 0.000125, frame.bottom + row * 0.000125, z);
        with_body += contact.distance < 1;
        ASSERT_GT(contact.distance, 0) << column << " " << row << " " << z;
      }
  EXPECT_GT(with_body, 1000000);
}

TEST(BodyMaps, BesideTheMapsThereIsNoContact) {
  const BodyMaps maps(surface_of(SphereShape{0.1, 6}), {.pixel = pixel});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double sign : {-1.0, 1.0}) {
    for (const double far : {0.12, 1.0, 1e9, 1e30}) {
      EXPECT_EQ(maps.contact(sign * far, 0.0, 0.0).distance, 1e30F);
      EXPECT_EQ(maps.contact(0.0, sign * far, 0.0).distance, 1e30F);
      EXPECT_EQ(maps.contact(static_cast<float>(sign * far), 0.0F, 0.0F).distance, 1e30F);
    }
    EXPECT_FALSE(maps.contact(sign * HUGE_VAL, 0.0, 0.0).distance < 0);
  }
  EXPECT_FALSE(maps.contact(nan, 0.0, 0.0).distance < 0);
  EXPECT_FALSE(maps.contact(0.0, nan, 0.0).distance < 0);
  EXPECT_FALSE(maps.contact(0.0, 0.0, nan).distance < 0);
  EXPECT_LT(maps.contact(0.0, 0.0, 0.0).distance, -0.09);
}

TEST(BodyMaps, APointThatStepsInsideIsAnsweredByItsPixel) {
  // The front of the box is the plane z = 0.5: the point would be 9 mm behind it.
  const BodyMaps maps(surface_of(BoxShape{{1, 1, 1}, {4, 4, 4}}), {.pixel = 0.01});
  Vec3d x{0.1, 0, 0.501}, v{3, 0, -1};
  EXPECT_FALSE(maps.respond(x, v, 0.5, 1.0, 0.01));
  EXPECT_NEAR(length(x - Vec3d{0.1, 0, 0.501}), 0, 1e-7);
  EXPECT_NEAR(length(v - Vec3d{2.5, 0, 0}), 0, 1e-7);
  // It is where the step leads that counts: outside the body's front now, beside it then.
  Vec3<float> beside{0.48F, 0, 0.45F}, away{3, 0, 0};
  EXPECT_FALSE(maps.respond(beside, away, 0.5F, 1.0F, 0.05F));
  EXPECT_EQ(away, (Vec3<float>{3, 0, 0}));
  EXPECT_EQ(beside, (Vec3<float>{0.48F, 0, 0.45F}));
  Vec3<float> resting{0, 0, -0.5F}, falling{0, 0.25F, 1};
  EXPECT_TRUE(maps.respond(resting, falling, 0.5F, 1.0F, 0.01F));
  EXPECT_EQ(falling, (Vec3<float>{}));
}

// The pixels of a body's maps: which there are, what they take, and what they do not depend on.

bool is_empty(const BodyPixel& p) {
  return p.front_x == 0 && p.front_y == 0 && p.front_z == 0 && p.front_at == -1e30F && p.back_x == 0 &&
         p.back_y == 0 && p.back_z == 0 && p.back_at == -1e30F;
}

TEST(BodyMaps, ReachBeyondTheSilhouetteByTheDilation) {
  const Surface surface = surface_of(SphereShape{0.05, 20});
  const double inner = enclosed_radius(surface) - micrometre, outer = 0.05 + micrometre;
  constexpr int dilation = 2;
  const BodyMaps maps(surface, {.pixel = pixel});
  const BodyFrame& frame = maps.frame();
  int beyond = 0;
  const auto radius_at = [&](int column, int row) {
    return std::hypot(double{frame.left} + (column + 0.5) * pixel,
                      double{frame.bottom} + (row + 0.5) * pixel);
  };
  const auto at = [&](int column, int row) -> const BodyPixel& {
    return maps.pixels()[static_cast<std::size_t>(row) * static_cast<std::size_t>(frame.columns) +
                         static_cast<std::size_t>(column)];
  };
  for (int row = 0; row < frame.rows; ++row)
    for (int column = 0; column < frame.columns; ++column) {
      const bool border = row == 0 || column == 0 || row + 1 == frame.rows || column + 1 == frame.columns;
      if (border) {
        ASSERT_TRUE(is_empty(at(column, row)));
        continue;
      }
      bool reached = false, in_doubt = false, repeats = false;
      for (int i = -dilation; i <= dilation; ++i)
        for (int j = -dilation; j <= dilation; ++j) {
          const double radius = radius_at(column + i, row + j);
          reached = reached || radius < inner;
          in_doubt = in_doubt || (radius >= inner && radius <= outer);
          const bool within =
              column + i >= 0 && column + i < frame.columns && row + j >= 0 && row + j < frame.rows;
          repeats =
              repeats || (within && radius <= outer && same_bits(at(column + i, row + j), at(column, row)));
        }
      if (reached) {
        ASSERT_FALSE(is_empty(at(column, row))) << column << " " << row;
      } else if (!in_doubt) {
        ASSERT_TRUE(is_empty(at(column, row))) << column << " " << row;
      }
      if (radius_at(column, row) > outer && reached) {
        ++beyond;
        EXPECT_TRUE(repeats);
      }
    }
  // A ring of the circumference times its width, corners making it somewhat wider.
  const double ring = 2 * std::numbers::pi * 0.05 / pixel * dilation;
  EXPECT_GE(beyond, 0.9 * ring);
  EXPECT_LE(beyond, 1.5 * ring);
}

TEST(BodyMaps, ThreadsDoNotMatter) {
  const Surface surface = surface_of(SphereShape{0.2, 16});
  const BodyMaps usual(surface, {.offset = 0.003});
  const int usual_threads = omp_get_max_threads();
  for (const int threads : {1, 2, 3}) {
    omp_set_num_threads(threads);
    EXPECT_TRUE(same_bits(BodyMaps(surface, {.offset = 0.003}), usual)) << threads;
  }
  omp_set_num_threads(usual_threads);
  EXPECT_FALSE(same_bits(BodyMaps(surface, {.offset = 0.004}), usual));
}

TEST(BodyMaps, TheOrderOfPointsAndTrianglesDoesNotMatter) {
  const Surface ball = surface_of(SphereShape{0.15, 6});
  const BodyMaps maps(ball, {.offset = 0.003});
  EXPECT_TRUE(same_bits(BodyMaps(renumbered(ball), {.offset = 0.003}), maps));
  // Triangles in another order: sums of normals are rounded differently.
  const BodyMaps other(shuffled(ball), {.offset = 0.003});
  ASSERT_EQ(other.pixels().size(), maps.pixels().size());
  RandomPoints random;
  for (int i = 0; i < 5000; ++i) {
    const Vec3d p = random.point(-0.2, 0.25);
    EXPECT_NEAR(other.contact(p.x, p.y, p.z).distance, maps.contact(p.x, p.y, p.z).distance, 1e-6);
  }
}

TEST(BodyMaps, ReachAsFarAsTheOffsetAndTheDilation) {
  const Surface surface = surface_of(SphereShape{0.1, 6});
  // 0.2 m and on each side the offset, two pixels of dilation and one that stays empty: 90 pixels.
  const BodyMapSettings settings{.pixel = 0.0025, .offset = 0.005};
  const BodyMaps maps(surface, settings);
  EXPECT_NEAR(maps.frame().columns, 90, 1);
  EXPECT_NEAR(maps.frame().rows, 90, 1);
}

std::string complaint(const BodyMapSettings& settings) {
  return sentence_of<std::invalid_argument>([&] { const BodyMaps maps(unit_cube(), settings); });
}

TEST(BodyMaps, WhatCannotBeIsNamed) {
  EXPECT_EQ(complaint({.pixel = 0.1}), "");
  EXPECT_THAT(complaint({.pixel = 0}), HasSubstr("pixels of 0 m; give a positive size"));
  EXPECT_THAT(complaint({.pixel = std::numeric_limits<double>::quiet_NaN()}), HasSubstr("pixels of nan m"));
  EXPECT_THAT(complaint({.pixel = 0.1, .offset = HUGE_VAL}), HasSubstr("offset of inf m; give a finite"));
  EXPECT_THAT(complaint({.pixel = 0.0001}), HasSubstr("10006 pixels of 1e-04 m along x; give larger pixels"));
  Surface open = unit_cube();
  open.triangles.pop_back();
  EXPECT_THAT(sentence_of<InputError>([&] { BodyMaps{open}; }), HasSubstr("the body: the edge from"));
}

// What a camera sees of a body: depth and normals.

Surface stretched(Surface surface, const Vec3d& by) {
  for (Vec3d& point : surface.points) point = {by.x * point.x, by.y * point.y, by.z * point.z};
  return surface;
}

TEST(SideMap, DepthAndNormalsOfAnEllipsoidAreAsGoodAsItsMesh) {
  const Surface unit = surface_of(SphereShape{1, 24});
  const MeshOfSphere mesh(unit, 1);
  for (const Vec3d& axes : {Vec3d{1, 1, 1}, Vec3d{0.5, 1, 0.7}, Vec3d{1, 0.6, 0.4}}) {
    const Surface ellipsoid = stretched(unit, axes);
    const std::vector<Vec3d> normals = vertex_normals(ellipsoid);
    const auto [shortest, longest] = std::minmax({axes.x, axes.y, axes.z});
    const PixelGrid grid{-1.1, -1.1, 0.01, 220, 220};
    for (const ViewFrom view : {ViewFrom::front, ViewFrom::back}) {
      const SideMap map = side_map(ellipsoid, normals, grid, view);
      const double camera = view == ViewFrom::front ? 1 : -1;
      double error_sum = 0;
      int pixels = 0;
      for (std::uint32_t row = 0; row < grid.rows; ++row)
        for (std::uint32_t column = 0; column < grid.columns; ++column) {
          const double x = grid.centre_x(column) / axes.x, y = grid.centre_y(row) / axes.y;
          const double inner = 1 - mesh.shell - micrometre, outer = 1 + micrometre;
          const std::size_t at = std::size_t{row} * grid.columns + column;
          if (x * x + y * y >= outer * outer) {
            EXPECT_EQ(map.depth[at], -camera * HUGE_VAL);
            EXPECT_EQ(map.normal[at], Vec3d{});
            continue;
          }
          if (x * x + y * y >= inner * inner) continue;
          const double depth = camera * map.depth[at] / axes.z;
          // The fixed-point rounding moves corners by up to 1 / 32768 of a pixel, which matters in steep
          // places.
          const double nearest = std::sqrt(inner * inner - x * x - y * y);
          const double slack = 1e-6 / nearest;
          EXPECT_GE(depth, nearest - slack);
          EXPECT_LE(depth, std::sqrt(outer * outer - x * x - y * y) + slack);
          const Vec3d on_sphere{x, y, camera * std::sqrt(1 - x * x - y * y)};
          const Vec3d exact{on_sphere.x / axes.x, on_sphere.y / axes.y, on_sphere.z / axes.z};
          EXPECT_NEAR(length(map.normal[at]), 1, 1e-12);
          // Normals are stretched by 1 / axes, which changes angles by the ratio of the axes at most. Before
          // the camera the point of the sphere is that beside the mesh's, but steep in the silhouette.
          if (on_sphere.z * camera < 0.2) continue;
          const double error = angle_between(map.normal[at], exact);
          EXPECT_LE(error, longest / shortest * mesh.normal_error());
          error_sum += error;
          ++pixels;
        }
      // A triangle's own normal is half an angle off on average; interpolation is to be far better.
      EXPECT_GT(pixels, 8000);
      EXPECT_LT(error_sum / pixels, 0.1 * longest / shortest * mesh.angle);
    }
  }
}

TEST(VertexNormals, OfABoxPointAlongItsCornersHoweverItsFacesAreCut) {
  // Two triangles meet in some corners of a face and one in others: weighting by angle makes that nothing.
  const Surface cube = unit_cube();
  const std::vector<Vec3d> normals = vertex_normals(cube);
  for (std::size_t p = 0; p < cube.points.size(); ++p) {
    const Vec3d outwards = cube.points[p] - Vec3d{0.5, 0.5, 0.5};
    EXPECT_NEAR(angle_between(normals[p], outwards), 0, 1e-12);
    EXPECT_NEAR(length(normals[p]), 1, 1e-12);
  }
  const Surface larger = inflated(cube, normals, std::sqrt(3.0) / 4);
  for (std::size_t p = 0; p < cube.points.size(); ++p)
    EXPECT_NEAR(length(larger.points[p] - (1.5 * cube.points[p] - Vec3d{0.25, 0.25, 0.25})), 0, 1e-12);
}

}  // namespace
}  // namespace mssim
