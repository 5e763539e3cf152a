// Pictures of small scenes, pixel by pixel: they look as they did, and within one level of a channel alike on
// every processor. Only functions of the C library (sines, powers) and what the compiler makes of sums may
// differ.
//
// A change that is not meant to change pictures leaves tests/output/pictures/golden as it is. After one that
// is, look at what the failing test has written, and put it there.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "output/pictures/painter.h"
#include "picture/picture.h"
#include "platform/files.h"
#include "tests/support/cloth_system.h"
#include "tests/support/png_fixture.h"
#include "tests/support/scene_files.h"
#include "tests/support/solid_system.h"
#include "tests/support/temporary_folder.h"

namespace mssim {
namespace {

constexpr int most_levels = 1;

/// The picture of `position`, 240 x 180 pixels.
Picture picture_of(const System& system, const std::vector<Vec3d>& position, ColourBy colour) {
  const TraceContent content = trace_content_of(system, {}, {});
  Painter painter(content, system.start.position, {{35, 18}, 240, 180, colour, 2});
  painter.make_room_for(position);
  return painter.picture_of(position);
}

/// By how many levels the channels of two pictures of the same size differ at most.
int largest_difference(const Picture& a, const Picture& b) {
  int largest = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    largest = std::max({largest, std::abs(a.pixels[i].red - b.pixels[i].red),
                        std::abs(a.pixels[i].green - b.pixels[i].green),
                        std::abs(a.pixels[i].blue - b.pixels[i].blue)});
  return largest;
}

void expect_golden(const Picture& drawn, const std::string& name) {
  const std::string committed = source_file("tests/output/pictures/golden/" + name);
  const Picture golden = std::filesystem::exists(committed) ? decoded(text_of(committed)) : Picture();
  const bool same_size = golden.width == drawn.width && golden.height == drawn.height;
  const int difference = same_size ? largest_difference(golden, drawn) : 255;
  testing::Test::RecordProperty("largest_difference", difference);
  if (difference <= most_levels) return;
  const std::string written = testing::TempDir() + name;
  write_file_atomically(written, png_of(drawn));
  ADD_FAILURE() << name << " differs by " << difference << " levels; what was drawn is in " << written;
}

TEST(GoldenPicture, OfTheStrainOfAWavyCloth) {
  const System system = build_system(sheet_spec(24, 30, 0.5));
  std::vector<Vec3d> position = system.start.position;
  const Vec3d middle = 0.5 * (position.front() + position.back());
  for (Vec3d& point : position) {
    const Vec3d at = (1 / 0.15) * (point - middle);  // -1 to 1 in x, less in z
    point.y += 0.06 * at.x * (at.x * at.x - 0.7) - 0.03 * at.z * at.z;
  }
  expect_golden(picture_of(system, position, ColourBy::strain), "wavy-cloth.png");
}

TEST(GoldenPicture, OfTwoBlocks) {
  const System system = two_solid_blocks();
  std::vector<Vec3d> position = system.start.position;
  for (Vec3d& point : position) point.x -= point.x > 0.3 ? 0.4 : 0;  // the second above the first
  for (Vec3d& point : position) point.z += 3 * (point.y - 0.5) * (point.y - 0.5);
  expect_golden(picture_of(system, position, ColourBy::object), "two-blocks.png");
}

}  // namespace
}  // namespace mssim
