// Jeans for a person with arms: they are cut whatever the heights that the scene gives, and fit on every
// backend.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "application/prepared_scene.h"
#include "garment/scene/garment_body.h"
#include "garment/scene/garment_cut.h"
#include "scene/scene_kinds.h"
#include "tests/support/body_with_arms.h"
#include "tests/support/dressed_jeans.h"
#include "tests/support/obj_text.h"
#include "tests/support/open_count.h"
#include "tests/support/temporary_folder.h"

namespace mssim {
namespace {

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

}  // namespace
}  // namespace mssim
