// The pixels of a body's maps: which there are, what they take, and what they do not depend on.
#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "garment/body/mannequin.h"
#include "garment/contact/body_maps.h"
#include "mesh/shapes.h"
#include "mesh/surface_file.h"
#include "tests/support/body_maps_fixture.h"
#include "tests/support/mesh_fixture.h"

namespace mssim {
namespace {

using testing::HasSubstr;

bool is_empty(const BodyPixel& p) {
  return p.front_x == 0 && p.front_y == 0 && p.front_z == 0 && p.front_at == -1e30F && p.back_x == 0 &&
         p.back_y == 0 && p.back_z == 0 && p.back_at == -1e30F;
}

TEST(BodyMaps, ReachBeyondTheSilhouetteByTheDilation) {
  const Surface surface = surface_of(SphereShape{0.05, 20});
  const double inner = enclosed_radius(surface) - micrometre, outer = 0.05 + micrometre;
  for (const int dilation : {0, 1, 2, 5}) {
    const BodyMaps maps(surface, {.pixel = pixel, .dilation = dilation});
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
          ASSERT_FALSE(is_empty(at(column, row))) << dilation << ": " << column << " " << row;
        } else if (!in_doubt) {
          ASSERT_TRUE(is_empty(at(column, row))) << dilation << ": " << column << " " << row;
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
}

TEST(BodyMaps, ThreadsDoNotMatter) {
  const Surface surface = surface_of(SphereShape{0.2, 16});
  const BodyMaps once(surface, {.offset = 0.003, .threads = 1});
  for (const int threads : {2, 3, 0})
    EXPECT_TRUE(same_bits(BodyMaps(surface, {.offset = 0.003, .threads = threads}), once)) << threads;
  EXPECT_FALSE(same_bits(BodyMaps(surface, {.offset = 0.004, .threads = 1}), once));
}

/// A barrel of quadrilaterals, with polygons as lids, as an OBJ file with its points in the given order.
std::string barrel_as_obj(bool backwards) {
  constexpr int around = 24, rings = 9;
  std::vector<std::string> points;
  const auto number = [&](int ring, int step) {
    const int index = ring * around + step % around;
    return std::to_string(backwards ? around * rings - index : index + 1);
  };
  std::string faces;
  for (int ring = 0; ring < rings; ++ring)
    for (int step = 0; step < around; ++step) {
      const double angle = 2 * std::numbers::pi * step / around,
                   bulge = 0.1 + 0.002 * ring * (rings - 1 - ring);
      points.push_back("v " + std::to_string(bulge * std::sin(angle)) + " " + std::to_string(0.03 * ring) +
                       " " + std::to_string(bulge * std::cos(angle)) + "\n");
      if (ring + 1 < rings)
        faces += "f " + number(ring, step) + " " + number(ring, step + 1) + " " + number(ring + 1, step + 1) +
                 " " + number(ring + 1, step) + "\n";
    }
  faces += "f";
  for (int step = around; step-- > 0;) faces += " " + number(0, step);
  faces += "\nf";
  for (int step = 0; step < around; ++step) faces += " " + number(rings - 1, step);
  if (backwards) std::ranges::reverse(points);
  std::string text;
  for (const std::string& point : points) text += point;
  return text + faces + "\n";
}

TEST(BodyMaps, TheOrderOfAFilesPointsDoesNotMatter) {
  const Surface barrel = parse_obj("barrel.obj", barrel_as_obj(false));
  ASSERT_EQ(barrel.triangles.size(), 2U * 24 * 8 + 2 * 22);
  const BodyMaps maps(barrel, {.offset = 0.003});
  EXPECT_TRUE(same_bits(BodyMaps(parse_obj("barrel.obj", barrel_as_obj(true)), {.offset = 0.003}), maps));
  EXPECT_TRUE(same_bits(BodyMaps(renumbered(barrel), {.offset = 0.003}), maps));
  // Triangles in another order: sums of normals are rounded differently.
  const BodyMaps other(shuffled(barrel), {.offset = 0.003});
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

TEST(BodyMaps, TakeNoMoreRoomForMoreTriangles) {
  const Surface coarse = mannequin({}, {.cells_around = 20}), fine = mannequin({}, {.cells_around = 112});
  EXPECT_NEAR(static_cast<double>(coarse.triangles.size()), 2'000, 400);
  EXPECT_NEAR(static_cast<double>(fine.triangles.size()), 60'000, 3'000);
  const BodyMaps few(coarse, {.pixel = 0.01}), many(fine, {.pixel = 0.01});
  // Both bodies reach as far to a pixel, and each has one record of two planes a pixel.
  EXPECT_NEAR(many.frame().columns, few.frame().columns, 1);
  EXPECT_NEAR(many.frame().rows, few.frame().rows, 1);
  for (const BodyMaps* maps : {&few, &many})
    EXPECT_EQ(maps->pixels().size_bytes(), std::size_t{32} * static_cast<std::size_t>(maps->frame().columns) *
                                               static_cast<std::size_t>(maps->frame().rows));
}

std::string complaint(const BodyMapSettings& settings) {
  try {
    const BodyMaps maps(unit_cube(), settings);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(BodyMaps, WhatCannotBeIsNamed) {
  EXPECT_EQ(complaint({.pixel = 0.1}), "");
  EXPECT_THAT(complaint({.pixel = 0}), HasSubstr("pixels of 0 m; give a positive size"));
  EXPECT_THAT(complaint({.pixel = std::numeric_limits<double>::quiet_NaN()}), HasSubstr("pixels of nan m"));
  EXPECT_THAT(complaint({.pixel = 0.1, .offset = HUGE_VAL}), HasSubstr("offset of inf m; give a finite"));
  EXPECT_THAT(complaint({.pixel = 0.1, .dilation = -1}), HasSubstr("dilated by -1 pixels; give 0 to 64"));
  EXPECT_THAT(complaint({.pixel = 0.0001}), HasSubstr("10006 pixels of 1e-04 m along x; give larger pixels"));
  Surface open = unit_cube();
  open.triangles.pop_back();
  EXPECT_THAT(input_error_of([&] { BodyMaps{open}; }), HasSubstr("the body: the edge from"));
}

}  // namespace
}  // namespace mssim
