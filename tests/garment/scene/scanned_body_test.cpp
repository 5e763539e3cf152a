// Jeans for bodies from files: whatever their format, unit, order of points and place before or behind z = 0.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string>

#include "commands/command.h"
#include "scene/fields/fields.h"
#include "tests/support/body_with_arms.h"
#include "tests/support/contact_fixture.h"
#include "tests/support/dressed_jeans.h"
#include "tests/support/temporary_folder.h"

namespace mssim {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::IsEmpty;

/// The corners of two triangles that share an edge, as a polygon which is cut into them from its first
/// corner.
std::optional<std::array<std::uint32_t, 4>> as_quad(std::array<std::uint32_t, 3> first,
                                                    std::array<std::uint32_t, 3> second) {
  for (int turn = 0; turn < 3; ++turn, std::rotate(first.begin(), first.begin() + 1, first.end()))
    for (int other = 0; other < 3; ++other, std::rotate(second.begin(), second.begin() + 1, second.end()))
      if (first[0] == second[0] && first[2] == second[1])
        return std::array{first[0], first[1], first[2], second[2]};
  return std::nullopt;
}

struct ObjText {
  std::string text;
  std::size_t quads = 0;
};

ObjText as_obj(const Surface& surface, double unit_m) {
  std::ostringstream text;
  text.precision(12);
  ObjText obj;
  for (const Vec3d& point : surface.points)
    text << "v " << point.x / unit_m << ' ' << point.y / unit_m << ' ' << point.z / unit_m << '\n';
  const auto& triangles = surface.triangles;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto quad = t + 1 < triangles.size() ? as_quad(triangles[t], triangles[t + 1]) : std::nullopt;
    text << 'f';
    if (quad) {
      for (const std::uint32_t corner : *quad) text << ' ' << corner + 1;
      ++obj.quads;
      ++t;
    } else {
      for (const std::uint32_t corner : triangles[t]) text << ' ' << corner + 1;
    }
    text << '\n';
  }
  obj.text = text.str();
  return obj;
}

std::string as_stl(const Surface& surface) {
  std::ostringstream text;
  text.precision(9);
  text << "solid body\n";
  for (const auto& triangle : surface.triangles) {
    text << "facet normal 0 0 0\nouter loop\n";
    for (const std::uint32_t corner : triangle) {
      const Vec3d& point = surface.points[corner];
      text << "vertex " << point.x << ' ' << point.y << ' ' << point.z << '\n';
    }
    text << "endloop\nendfacet\n";
  }
  text << "endsolid body\n";
  return text.str();
}

class ScannedBody : public TemporaryFolderTest {
 protected:
  /// The mannequin of jeans1k, coarser than there.
  static Surface body() {
    const json scene = json::parse(text_of(source_file("scenes/jeans1k.json")));
    MannequinResolution resolution;
    resolution.cells_around = 48;
    BodyMeasures measures;
    measures.stance = scene["garment"]["mannequin"]["stance_m"];
    return mannequin(measures, resolution);
  }
  /// jeans1k for the body of a file beside it.
  SceneSpec scene_for(const std::string& file, double unit_m) const {
    json scene = json::parse(text_of(source_file("scenes/jeans1k.json")));
    json& garment = scene["garment"];
    garment.erase("mannequin");
    garment.erase("expected");
    garment["body"] = "surface_file";
    garment["surface_file"] = {{"file", file}, {"unit_m", unit_m}};
    return find_scene(put("jeans.json", scene.dump()).string());
  }
};

TEST_F(ScannedBody, AsAnObjFileOfQuadsInCentimetresInAnyOrderIsDressed) {
  const ObjText obj = as_obj(body(), 0.01);
  EXPECT_GT(obj.quads, body().triangles.size() / 3);
  const ObjText shuffled_obj = as_obj(renumbered(body()), 0.01);
  put("body.obj", shuffled_obj.text);
  const DressingCase jeans(scene_for("body.obj", 0.01));
  EXPECT_EQ(jeans.body->surface.triangles.size(), body().triangles.size());
  EXPECT_THAT(dressed(jeans).found, IsEmpty());
}

TEST_F(ScannedBody, AsAnStlFileIsDressed) {
  put("body.stl", as_stl(shuffled(body())));
  EXPECT_THAT(dressed(DressingCase(scene_for("body.stl", 1))).found, IsEmpty());
}

TEST_F(ScannedBody, ThatStandsFurtherBackIsDressedWhereItStands) {
  Surface surface = body();
  for (Vec3d& point : surface.points) point.z -= 0.3;
  put("body.obj", as_obj(surface, 1).text);
  EXPECT_THAT(dressed(DressingCase(scene_for("body.obj", 1))).found, IsEmpty());
}

TEST_F(ScannedBody, OfAPersonIsDressedByTheSceneThatMeasureWritesForIt) {
  const Surface person =
      posed(body_with_arms(), {.unit_m = 0.001, .turn_degrees = 90, .shift = {0.4, 0.1, -2}, .z_up = true});
  const std::string body = put("scan.obj", as_obj(person, 1).text).string();
  const std::string scene = (folder() / "my.json").string();
  std::array arguments{"mssim", "measure", body.c_str(), "--scene", scene.c_str()};
  testing::internal::CaptureStdout();
  const int code = run_program(arguments.size(), const_cast<char**>(arguments.data()));
  EXPECT_THAT(testing::internal::GetCapturedStdout(), HasSubstr("waist_height"));
  ASSERT_EQ(code, 0);
  const DressingCase jeans(load_scene(scene));
  EXPECT_THAT(dressed(jeans).found, IsEmpty());
}

TEST_F(ScannedBody, ThatStandsAsideIsRefused) {
  Surface surface = body();
  for (Vec3d& point : surface.points) point.x += 0.3;
  put("body.obj", as_obj(surface, 1).text);
  try {
    build_system(scene_for("body.obj", 1));
    ADD_FAILURE() << "built";
  } catch (const SceneError& error) {
    EXPECT_THAT(
        error.what(),
        HasSubstr("/garment/surface_file has no leg on either side of x = 0, where jeans need one: let "));
  }
}

}  // namespace
}  // namespace mssim
