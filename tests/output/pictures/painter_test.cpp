#include "output/pictures/painter.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <utility>
#include <vector>

#include "output/traces/trace_content.h"
#include "tests/support/cloth_system.h"
#include "tests/support/solid_system.h"

namespace mssim {
namespace {

TraceContent content_of(const System& system) { return trace_content_of(system, {}, {}); }

PictureOptions options(ColourBy colour = ColourBy::object) { return {{35, 18}, 320, 240, colour, 2}; }

std::size_t differing(const Picture& a, const Picture& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) count += a.pixels[i] == b.pixels[i] ? 0U : 1U;
  return count;
}

/// Whether anything colourful touches the edge of the picture.
bool touches_edge(const Picture& picture) {
  const auto colourful = [&](std::uint32_t x, std::uint32_t y) {
    const Rgb& pixel = picture.at(x, y);
    return std::abs(pixel.red - pixel.blue) > 40;
  };
  for (std::uint32_t x = 0; x < picture.width; ++x)
    if (colourful(x, 0) || colourful(x, picture.height - 1)) return true;
  for (std::uint32_t y = 0; y < picture.height; ++y)
    if (colourful(0, y) || colourful(picture.width - 1, y)) return true;
  return false;
}

std::vector<Vec3d> moved(std::vector<Vec3d> positions, const Vec3d& by) {
  for (Vec3d& position : positions) position += by;
  return positions;
}

TEST(Painter, ShowsAllForWhichThereIsRoomFromTheSamePlace) {
  const System system = cloth_system(12, 15);
  const TraceContent content = content_of(system);
  const std::vector<Vec3d>& start = system.start.position;
  const std::vector<Vec3d> far = moved(start, {0.7, -0.3, 0.4});
  Painter painter(content, start, options());
  painter.make_room_for(start);
  const Picture close_up = painter.picture_of(start);
  EXPECT_FALSE(touches_edge(close_up));
  painter.make_room_for(far);
  EXPECT_FALSE(touches_edge(painter.picture_of(start)));
  EXPECT_FALSE(touches_edge(painter.picture_of(far)));
  EXPECT_NE(painter.picture_of(start), close_up);
}

TEST(Painter, GivesEachBodyAColour) {
  const System system = two_solid_blocks();
  const TraceContent content = content_of(system);
  Painter painter(content, system.start.position, options());
  painter.make_room_for(system.start.position);
  const Picture both = painter.picture_of(system.start.position);
  const System alone = solid_block(4, 5, 3);
  const TraceContent content_alone = content_of(alone);
  Painter painter_alone(content_alone, alone.start.position, options());
  painter_alone.make_room_for(alone.start.position);
  EXPECT_GT(differing(both, painter_alone.picture_of(alone.start.position)), 100U);
}

TEST(Painter, ShowsStrainWhereSpringsAreStretched) {
  const System system = cloth_system(12, 15);
  const TraceContent content = content_of(system);
  const std::vector<Vec3d>& start = system.start.position;
  std::vector<Vec3d> stretched = start;
  for (Vec3d& position : stretched) position.x *= 1.05;
  Painter painter(content, start, options(ColourBy::strain));
  painter.make_room_for(start);
  painter.make_room_for(stretched);
  // The red of stretched springs is hardly there at rest. The legend, above to the right, has both colours.
  const auto red = [](const Picture& picture) {
    std::size_t count = 0;
    for (std::uint32_t y = 0; y < picture.height; ++y)
      for (std::uint32_t x = 0; x < picture.width / 2; ++x)
        count += picture.at(x, y).red > picture.at(x, y).blue + 40 ? 1U : 0U;
    return count;
  };
  EXPECT_GT(red(painter.picture_of(stretched)), 10 * (1 + red(painter.picture_of(start))));
}

TEST(Painter, StandsThingsOnTheFloorThatTheSceneStates) {
  const System system = solid_block(4, 4, 4);
  TraceContent content = content_of(system);
  const std::vector<Vec3d> above = moved(system.start.position, {0, 0.02, 0});
  const auto picture = [&] {
    Painter painter(content, above, options());
    painter.make_room_for(above);
    return painter.picture_of(above);
  };
  const Picture without = picture();
  content.scene_json = R"({"floor": {"height_m": 0.5}})";
  EXPECT_GT(differing(picture(), without), 50U) << "its shadow lies elsewhere";
  for (const char* text : {"", "no json", "[]", R"({"floor": 3})", R"({"floor": {"height_m": "low"}})",
                           R"({"floor": {"height_m": -1e300}})"}) {
    content.scene_json = text;
    EXPECT_EQ(picture(), without) << text;
  }
}

TEST(NodeStrain, IsTheMeanOfTheNodesSprings) {
  TraceContent content;
  content.nodes = 4;
  content.springs = {{0, 1}, {1, 2}};
  content.rest_length = {1, 2};
  // Springs of 1.1 m and 2.6 m: 10 % and 30 % longer. The last node has none.
  const std::vector<double> strain = node_strain(content, {{0, 0, 0}, {1.1, 0, 0}, {1.1, 2.6, 0}, {9, 9, 9}});
  ASSERT_EQ(strain.size(), 4U);
  for (const auto& [node, expected] : {std::pair{0U, 0.1}, {1U, 0.2}, {2U, 0.3}, {3U, 0.0}})
    EXPECT_NEAR(strain[node], expected, 1e-12) << node;
}

}  // namespace
}  // namespace mssim
