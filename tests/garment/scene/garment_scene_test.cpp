// Jeans for a person with arms: they are cut whatever the heights that the scene gives, and fit on every
// backend.
#include "garment/scene/garment_scene.h"

#include "application/prepared_scene.h"
#include "commands/command.h"
#include "scene/fields/fields.h"
#include "scene/scene_kinds.h"
#include "tests/support/body_with_arms.h"
#include "tests/support/dressed_jeans.h"
#include "tests/support/files_fixture.h"
#include "tests/support/obj_text.h"
#include "tests/support/open_count.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

class DressedPerson : public TemporaryFolderTest {
 protected:
  SceneSpec scene_for(const std::string& name, const PersonForm& form) const {
    return scene_with(name, body_with_arms(form));
  }
  /// The scene, with this body from a file instead of its mannequin.
  SceneSpec scene_with(const std::string& name, const Surface& surface) const {
    SceneSpec spec = find_scene(name);
    BodyFile body;
    body.file = put("body.obj", obj_text(surface)).string();
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
    for (const double waist : {0.96, 0.985, 1.005, 1.04})
      for (const double hip : {0.84, 0.86, 0.88})
        for (const double knee : {0.44, 0.46, 0.48})
          for (const double hem : {0.05, 0.07, 0.10, 0.20}) {
            jeans.waist_height = waist;
            jeans.hip_height = hip;
            jeans.knee_height = knee;
            jeans.hem_height = hem;
            const FittedGarment cut = cut_and_placed(spec, profile);
            for (const Vec3d& node : cut.system.start.position) {
              ASSERT_LT(std::abs(node.z), 0.25) << "drawn to where the hands are";
              ASSERT_LT(std::abs(node.x), 0.40);
            }
          }
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

TEST_F(DressedPerson, IsDressedWithinAllBoundsWithFewTrianglesAndWithHandsAgainstTheHips) {
  for (const PersonForm& form :
       {PersonForm{.triangles = 1'600}, PersonForm{.triangles = 1'600, .arm_angle_degrees = 6},
        PersonForm{.triangles = 6'000, .arm_angle_degrees = 4},
        PersonForm{.triangles = 12'000, .arm_angle_degrees = 5}})
    EXPECT_THAT(dressed(DressingCase(scene_for("jeans4k", form)), {}, "openmp").found, IsEmpty())
        << form.triangles << " triangles, " << form.arm_angle_degrees << " degrees";
}

TEST_F(DressedPerson, IsSaidToHaveArmsThatTheGarmentIgnores) {
  const SceneSpec spec = scene_for("jeans1k", {.triangles = 1'600});
  EXPECT_THAT(build_scene(spec).note,
              AllOf(HasSubstr("(arms, hands, hair), from 0.6"), HasSubstr(" to 1.1")));
  EXPECT_EQ(build_scene(find_scene("jeans1k")).note, "");
  // As a command says it; the person is read and measured once.
  OpenCount count(folder() / "body.obj");
  const PreparedScene scene = prepare_scene(spec);
  EXPECT_THAT(scene.note, HasSubstr("garments ignore"));
  // What is drawn is the whole person.
  EXPECT_EQ(scene.body->surface.triangles.size(), 1'600U);
  EXPECT_EQ(count.value(), 1);
}

/// The mannequin of jeans1k, coarser than there, moved.
Surface moved_mannequin(const Vec3d& by) {
  const SceneSpec spec = find_scene("jeans1k");
  const auto& garment = std::get<GarmentSpec>(spec.content);
  Surface surface = mannequin(std::get<MannequinBody>(garment.body).measures, 48);
  for (Vec3d& point : surface.points) point += by;
  return surface;
}

TEST_F(DressedPerson, WhoStandsFurtherBackIsDressedThere) {
  EXPECT_THAT(dressed(DressingCase(scene_with("jeans1k", moved_mannequin({0, 0, -0.3})))).found, IsEmpty());
}

TEST_F(DressedPerson, IsDressedByTheSceneThatMeasureWritesForItsScan) {
  const Surface person =
      posed(body_with_arms(), {.unit_m = 0.001, .turn_degrees = 90, .shift = {0.4, 0.1, -2}, .z_up = true});
  const std::string body = put("scan.obj", obj_text(person)).string();
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
  EXPECT_EQ(garment.jeans->measures.thigh_ease, 0.029);
  EXPECT_EQ(garment.jeans->measures.crotch_ease, 0.037);
  EXPECT_THAT(dressed(jeans).found, IsEmpty());
}

TEST_F(DressedPerson, WhoStandsAsideIsRefused) {
  EXPECT_THAT(
      sentence_of<SceneError>([&] {
        build_system(scene_with("jeans1k", moved_mannequin({0.3, 0, 0})));
      }),
      AllOf(HasSubstr("/garment/surface_file has no leg on each side of x = 0"), HasSubstr("\"move_m\"")));
}

}  // namespace
}  // namespace mssim
