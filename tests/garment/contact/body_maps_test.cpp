// How points stand to a body, as its maps have it.
#include "garment/contact/body_maps.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "garment/contact/solid.h"
#include "geometry/surface.h"
#include "mesh/shapes.h"
#include "tests/support/body_maps_fixture.h"
#include "tests/support/mesh_fixture.h"

namespace mssim {
namespace {

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

}  // namespace
}  // namespace mssim
