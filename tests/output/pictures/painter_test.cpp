#include "output/pictures/painter.h"

#include <map>

#include "geometry/surface.h"
#include "output/traces/trace_reader.h"
#include "picture/picture.h"
#include "platform/files.h"
#include "tests/support/files_fixture.h"
#include "tests/support/garment_system.h"
#include "tests/support/picture_fixture.h"
#include "tests/support/systems.h"
#include "tests/support/testing.h"

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

TEST(Painter, MakesRoomForShadows) {
  const System system = solid_block(4, 4, 4);
  const TraceContent content = content_of(system);
  const std::vector<Vec3d> above = moved(system.start.position, {0, 0.3, 0});
  Painter painter(content, above, options());
  for (const std::vector<Vec3d>& positions : {above, system.start.position}) painter.make_room_for(positions);
  const Shot shot = painter.shot();
  const Camera camera(options().view);
  const double ground = shot.ground->met_by(camera, 0, 0).value().y;
  const Vec3d light = shadow_light(options().view);
  for (const Vec3d& point : above) {
    const Vec3d shadow = camera.seen(point - ((point.y - ground) / light.y) * light);
    EXPECT_LE(shot.seen.low.x, shadow.x + 1e-9);
    EXPECT_LE(shot.seen.low.y, shadow.y + 1e-9);
    EXPECT_GE(shot.seen.high.x, shadow.x - 1e-9);
    EXPECT_GE(shot.seen.high.y, shadow.y - 1e-9);
  }
  PictureOptions from_below = options();
  from_below.view.elevation = -20;
  Painter other(content, above, from_below);
  other.make_room_for(above);
  EXPECT_EQ(other.shot().seen.high.x, seen_box(Camera(from_below.view), above).high.x) << "no ground is seen";
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

TEST(Painter, DrawsALegendApart) {
  const System system = cloth_system(12, 15);
  const TraceContent content = content_of(system);
  const std::vector<Vec3d>& start = system.start.position;
  Painter plain(content, start, options()), strain(content, start, options(ColourBy::strain));
  EXPECT_FALSE(plain.has_legend());
  EXPECT_FALSE(ink_of(plain.legend()));
  EXPECT_TRUE(strain.has_legend());
  strain.make_room_for(moved(start, {}));
  const PixelBox legend = ink_of(strain.legend()).value();
  const Picture with = strain.picture_of(start), without = strain.picture_of(start, false);
  EXPECT_NE(with, without);
  for (std::uint32_t y = 0; y < with.height; ++y)
    for (std::uint32_t x = 0; x < with.width; ++x)
      if (static_cast<int>(x) < legend.left) {
        EXPECT_EQ(with.at(x, y), without.at(x, y));
      }
}

TEST(Painter, HasALegendOfPanelsThatAllLookDifferent) {
  const auto has_legend = [](const System& system) {
    const TraceContent content = content_of(system);
    return Painter(content, system.start.position, options(ColourBy::panel)).has_legend();
  };
  const auto panels = [](std::size_t count) {
    return garment_of(std::vector<SquarePanel>(count, {3, 4, 0.01, {0, 0, 0}}));
  };
  EXPECT_FALSE(has_legend(panels(1)));
  EXPECT_TRUE(has_legend(panels(2)));
  EXPECT_TRUE(has_legend(panels(8)));
  EXPECT_FALSE(has_legend(panels(9))) << "there are eight colours";
  EXPECT_FALSE(has_legend(two_solid_blocks())) << "bodies are no panels";
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

TEST(NodeStrain, IsUnknownWithoutRestLengths) {
  TraceContent content;
  content.nodes = 2;
  content.springs = {{0, 1}};
  EXPECT_FALSE(has_strain(content));
  EXPECT_THAT(node_strain(content, {{0, 0, 0}, {1, 0, 0}}), testing::Each(testing::IsNan()));
}

const PictureOptions small{{35, 18}, 160, 120, ColourBy::object, 2};

class PicturesOfARun : public TemporaryFolderTest {
 protected:
  const System system_ = cloth_system(12, 15);
  PictureFolder pictures_in(const std::filesystem::path& name) const {
    return {name, trace_content_of(system_, {}, {}), small};
  }
  static std::set<std::string> names_in(const std::filesystem::path& name) {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(name))
      names.insert(entry.path().filename().string());
    return names;
  }
};

TEST_F(PicturesOfARun, AreWhatAPainterDrawsOfAllSoFar) {
  const std::filesystem::path name = folder() / "new" / "pictures";
  const std::vector<Vec3d>& start = system_.start.position;
  std::vector<Vec3d> far = start;
  for (Vec3d& position : far) position += Vec3d{2, -0.5, 1};
  const TraceContent content = trace_content_of(system_, {}, {});
  Painter painter(content, start, small);
  {
    PictureFolder pictures = pictures_in(name);
    pictures.draw(start);
    pictures.draw(far);
    pictures.draw(start);
    EXPECT_EQ(pictures.pictures(), 3U);
  }
  EXPECT_EQ(names_in(name),
            (std::set<std::string>{"frame-000000.png", "frame-000001.png", "frame-000002.png"}));
  painter.make_room_for(start);
  EXPECT_EQ(decoded(read_file(name / "frame-000000.png")), painter.picture_of(start));
  painter.make_room_for(far);
  EXPECT_EQ(decoded(read_file(name / "frame-000001.png")), painter.picture_of(far));
  EXPECT_EQ(decoded(read_file(name / "frame-000002.png")), painter.picture_of(start));
}

TEST_F(PicturesOfARun, NeedAFolderOfTheirOwn) {
  put("used/notes.txt", "mine");
  put("file", "no folder");
  EXPECT_THROW(pictures_in(folder() / "used"), UsageError);
  EXPECT_THROW(pictures_in(folder() / "file"), WriteError);
  EXPECT_EQ(names_in(folder() / "used"), std::set<std::string>{"notes.txt"});
  const PictureFolder first = pictures_in(folder() / "pictures");
  EXPECT_THROW(pictures_in(folder() / "pictures"), WriteError);
}

Surface surface_of(const NodeSurface& skin, const std::vector<Vec3d>& position) {
  Surface surface{{}, skin.triangles};
  for (const std::uint32_t node : skin.node) surface.points.push_back(position[node]);
  return surface;
}

TEST(Skin, OfBodiesClosesAroundThem) {
  const System system = solid_block(3, 4, 5);
  const NodeSurface skin = skin_of(shape_of(system.topology), system.start.position);
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
  const NodeSurface skin = skin_of(shape_of(system.topology), system.start.position);
  std::map<std::uint32_t, std::size_t> points;
  for (const std::uint32_t node : skin.node) ++points[node];
  std::map<std::size_t, std::size_t> nodes_with;
  for (const auto& [node, count] : points) ++nodes_with[count];
  EXPECT_EQ(nodes_with[3], 8U) << "corners of the block";
  EXPECT_EQ(skin.node.size(), 3U * 8 + 2 * nodes_with[2] + nodes_with[1]);
}

// Pictures of small scenes, pixel by pixel: they look as they did, and within one level of a channel alike on
// every processor. Only functions of the C library (sines, powers) and what the compiler makes of sums may
// differ.
//
// A change that is not meant to change pictures leaves tests/output/pictures/golden as it is. After one that
// is, look at what the failing test has written, and put it there.

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
  const Picture golden = std::filesystem::exists(committed) ? decoded(read_file(committed)) : Picture();
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
