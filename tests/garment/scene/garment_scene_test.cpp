// Jeans for a person with arms: they are cut whatever the heights that the scene gives, and fit on every
// backend.
#include "garment/scene/garment_scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string>

#include "application/prepared_scene.h"
#include "commands/command.h"
#include "scene/fields/fields.h"
#include "scene/scene_kinds.h"
#include "tests/support/body_with_arms.h"
#include "tests/support/contact_fixture.h"
#include "tests/support/dressed_jeans.h"
#include "tests/support/files_fixture.h"
#include "tests/support/obj_text.h"
#include "tests/support/open_count.h"
#include "tests/support/sentence_of.h"

namespace mssim {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

class DressedPerson : public TemporaryFolderTest {
 protected:
  /// The scene, with this person instead of its mannequin.
  SceneSpec scene_for(const std::string& name, const PersonForm& form) const {
    SceneSpec spec = find_scene(name);
    BodyFile body;
    body.file = put("person.obj", obj_text(body_with_arms(form))).string();
    auto& garment = std::get<GarmentSpec>(spec.content);
    garment.body = body;
    garment.expected.reset();
    return spec;
  }
};

TEST_F(DressedPerson, IsCutJeansForWhateverHeightsTheSceneGives) {
  for (const std::size_t triangles : {1'600U, 12'000U}) {
    SceneSpec spec = scene_for("jeans1k", {.triangles = triangles});
    const BodyProfile profile = measured_body(spec).profile;
    JeansMeasures& jeans = std::get<GarmentSpec>(spec.content).jeans.value().measures;
    int accepted = 0;
    for (const double waist : {0.96, 0.985, 1.005, 1.04})
      for (const double hip : {0.84, 0.86, 0.88})
        for (const double knee : {0.44, 0.46, 0.48})
          for (const double hem : {0.05, 0.07, 0.10, 0.20}) {
            jeans.waist_height = waist;
            jeans.hip_height = hip;
            jeans.knee_height = knee;
            jeans.hem_height = hem;
            const FittedGarment cut = cut_and_placed(spec, profile);
            for (const Vec3d& node : cut.build.placed) {
              ASSERT_LT(std::abs(node.z), 0.25) << "drawn to where the hands are";
              ASSERT_LT(std::abs(node.x), 0.40);
            }
            ++accepted;
          }
    EXPECT_EQ(accepted, 144);
  }
}

class DressedPersonBy : public DressedPerson, public testing::WithParamInterface<std::string> {};

INSTANTIATE_TEST_SUITE_P(Backends, DressedPersonBy, testing::Values("serial", "openmp", "opencl"),
                         [](const auto& backend) { return backend.param; });

TEST_P(DressedPersonBy, WithinAllBoundsWithTheDefaultSkin) {
  const DressingCase jeans(scene_for("jeans4k", {.triangles = 6'000}));
  EXPECT_EQ(std::get<GarmentSpec>(jeans.spec.content).skin_m, GarmentSpec{}.skin_m);
  EXPECT_THAT(dressed(jeans, {}, GetParam()).found, IsEmpty());
}

TEST_F(DressedPerson, OfFewTrianglesIsDressedWithinAllBounds) {
  EXPECT_THAT(dressed(DressingCase(scene_for("jeans4k", {.triangles = 1'600})), {}, "openmp").found,
              IsEmpty());
}

TEST_F(DressedPerson, WhoseHandsRestAgainstTheHipsIsDressedWithinAllBounds) {
  for (const PersonForm& form : {PersonForm{.triangles = 1'600, .arm_angle_degrees = 6},
                                 PersonForm{.triangles = 6'000, .arm_angle_degrees = 4},
                                 PersonForm{.triangles = 12'000, .arm_angle_degrees = 5}})
    EXPECT_THAT(dressed(DressingCase(scene_for("jeans4k", form)), {}, "openmp").found, IsEmpty())
        << form.triangles << " triangles, " << form.arm_angle_degrees << " degrees";
}

TEST_F(DressedPerson, IsSaidToHaveArmsThatTheGarmentIgnores) {
  const SceneSpec spec = scene_for("jeans1k", {.triangles = 1'600});
  EXPECT_THAT(
      build_scene(spec).note,
      AllOf(
          HasSubstr("garments ignore what the body has beside trunk and legs (arms, hands, hair), from 0.6"),
          HasSubstr(" to 1.1")));
  EXPECT_EQ(build_scene(find_scene("jeans1k")).note, "");
  // As a command says it; the person is read and measured once.
  OpenCount count(folder() / "person.obj");
  const PreparedScene scene = prepare_scene(spec);
  EXPECT_THAT(scene.note, HasSubstr("garments ignore"));
  // What is drawn is the whole person.
  EXPECT_EQ(scene.body->surface.triangles.size(), 1'600U);
  EXPECT_EQ(count.value(), 1);
}

// Jeans for bodies from files: whatever their format, unit, order of points and place before or behind z = 0.

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
  const auto& garment = std::get<GarmentSpec>(jeans.spec.content);
  EXPECT_TRUE(garment.dressing.edge_held);
  EXPECT_EQ(garment.dressing.seaming_gravity, 1);
  // Twice what jeans4k has: seams of a held waistband were open after 1 s.
  EXPECT_EQ(garment.dressing.seam_force, 8);
  EXPECT_EQ(garment.dressing.longest_seaming_s, 2);
  EXPECT_EQ(garment.jeans->measures.thigh_ease, 0.01);
  EXPECT_EQ(garment.jeans->measures.crotch_ease, 0.04);
  EXPECT_THAT(dressed(jeans).found, IsEmpty());
}

TEST_F(ScannedBody, ThatStandsAsideIsRefused) {
  Surface surface = body();
  for (Vec3d& point : surface.points) point.x += 0.3;
  put("body.obj", as_obj(surface, 1).text);
  EXPECT_THAT(
      sentence_of<SceneError>([&] { build_system(scene_for("body.obj", 1)); }),
      HasSubstr("/garment/surface_file has no leg on either side of x = 0, where jeans need one: let "));
}

}  // namespace
}  // namespace mssim
