#include <gmock/gmock.h>

#include <limits>
#include <numeric>

#include "garment/pattern/garment_build.h"
#include "model/topology.h"
#include "tests/support/mesh_fixture.h"
#include "tests/support/rectangle_piece.h"

namespace mssim {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

struct Springs {
  std::vector<Spring> springs;
  std::vector<SpringMaterial> materials;
};

Springs springs_of_panel(const PanelMesh& mesh, const PanelMaterial& cloth, std::uint32_t first_node = 0) {
  Springs made;
  append_springs({"p", mesh.rows, mesh.columns, first_node, 0}, mesh, cloth, made.springs, made.materials);
  return made;
}

double sum_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

TEST(PanelSprings, ASquareGridHasTheSpringsOfACloth) {
  const PanelMesh mesh = mesh_panel(rectangle_piece("p", 0.5, 0.7), {8, 6});
  const std::vector<Spring> cloth = springs_of(GridPatch{8, 6, 0.1});
  const Springs panel = springs_of_panel(mesh, {}, 100);
  ASSERT_EQ(panel.springs.size(), cloth.size());
  ASSERT_EQ(panel.springs.size(), count_springs(8, 6));
  for (std::size_t i = 0; i < cloth.size(); ++i) {
    EXPECT_EQ(panel.springs[i].first, cloth[i].first + 100);
    EXPECT_EQ(panel.springs[i].second, cloth[i].second + 100);
    EXPECT_EQ(panel.springs[i].kind, cloth[i].kind);
    EXPECT_NEAR(panel.springs[i].rest_length, cloth[i].rest_length, 2e-6);
  }
  ASSERT_EQ(panel.materials.size(), 3U);
  EXPECT_EQ(panel.materials[structural].stiffness, 200);
  EXPECT_EQ(panel.materials[shear].stiffness, 60);
  EXPECT_EQ(panel.materials[bending].stiffness, 8);
}

TEST(PanelSprings, BendingSpringsAreAsLongAsTheStraightDistance) {
  PatternPiece piece = rectangle_piece("p", 0.2, 0.2);
  piece.bottom = Curve({{0, 0, 0}, {0.1, -0.1, 0}, {0.2, 0, 0}});
  const Springs panel = springs_of_panel(mesh_panel(piece, {3, 3}), {});
  const auto length_from_first_to = [&](std::uint32_t node) {
    const auto spring = std::ranges::find_if(
        panel.springs, [&](const Spring& s) { return s.first == 0 && s.second == node; });
    return spring == panel.springs.end() ? 0 : spring->rest_length;
  };
  EXPECT_NEAR(length_from_first_to(2), 0.2, 1e-6);
  EXPECT_NEAR(length_from_first_to(1), 0.1 * std::sqrt(2.0), 1e-6);
}

TEST(PanelSprings, AWaistbandIsStifferAlongItsRows) {
  const PanelMesh mesh = mesh_panel(rectangle_piece("p", 0.5, 0.7), {8, 6});
  PanelMaterial cloth;
  cloth.waistband.height = 0.25;
  EXPECT_EQ(waistband_rows(mesh, cloth.waistband), 3U);
  Springs panel = springs_of_panel(mesh, cloth);
  ASSERT_EQ(panel.materials.size(), 4U);
  EXPECT_EQ(panel.materials[3].stiffness, 1600);
  std::size_t hoops = 0;
  for (const Spring& spring : panel.springs) {
    const bool hoop = spring.first >= 5 * 6 && spring.second == spring.first + 1;
    EXPECT_EQ(spring.kind == 3, hoop);
    hoops += hoop ? 1 : 0;
  }
  EXPECT_EQ(hoops, 3U * 5);
}

TEST(PanelSprings, AWaistbandHoldsTheTopRowAtLeastAndNoneWithoutHeight) {
  const PanelMesh mesh = mesh_panel(rectangle_piece("p", 0.5, 0.7), {8, 6});
  EXPECT_EQ(waistband_rows(mesh, {0}), 0U);
  EXPECT_EQ(waistband_rows(mesh, {0.001}), 1U);
  EXPECT_EQ(waistband_rows(mesh, {0.1}), 2U);
  EXPECT_EQ(waistband_rows(mesh, {5}), 8U);
}

TEST(PanelSprings, EachPanelBringsItsOwnMaterials) {
  const PanelMesh mesh = mesh_panel(rectangle_piece("p", 0.5, 0.7), {8, 6});
  Springs both = springs_of_panel(mesh, {});
  PanelMaterial stiff;
  stiff.structural.stiffness = 500;
  append_springs({"q", 8, 6, 48, 0}, mesh, stiff, both.springs, both.materials);
  ASSERT_EQ(both.materials.size(), 6U);
  for (const Spring& spring : both.springs) EXPECT_EQ(spring.kind >= 3, spring.first >= 48);
  EXPECT_EQ(both.materials[3].stiffness, 500);
}

TEST(PanelSprings, MassesSumToTheAreaTimesTheDensity) {
  // A trapezoid of 0.75 x 0.5 m^2 on the mean.
  const Vec3d a{0, 0, 0}, b{1, 0, 0}, c{0.25, 0.5, 0}, d{0.75, 0.5, 0};
  const PanelMesh mesh =
      mesh_panel({"p", Curve({a, b}), Curve({c, d}), Curve({a, c}), Curve({b, d})}, {17, 9});
  EXPECT_NEAR(area_of(mesh), 0.375, 1e-6);
  EXPECT_NEAR(sum_of(node_masses(mesh, {})), 0.4 * 0.375, 1e-6);
}

TEST(PanelSprings, ANodeWeighsAQuarterOfItsCells) {
  const std::vector<double> masses = node_masses(mesh_panel(rectangle_piece("p", 0.2, 0.2), {3, 3}), {});
  const double cell = 0.4 * 0.01;
  for (const auto& [node, cells] : {std::pair{0, 0.25}, {1, 0.5}, {3, 0.5}, {4, 1.0}, {8, 0.25}})
    EXPECT_NEAR(masses[static_cast<std::size_t>(node)], cells * cell, 1e-12);
}

TEST(PanelSprings, AWaistbandIsHeavierAndNodesMayHaveALeastMass) {
  const PanelMesh mesh = mesh_panel(rectangle_piece("p", 0.2, 0.2), {3, 3});
  const std::vector<double> plain = node_masses(mesh, {});
  PanelMaterial cloth;
  cloth.waistband.height = 0.02;
  const std::vector<double> banded = node_masses(mesh, cloth);
  for (std::size_t i = 0; i < 9; ++i) EXPECT_DOUBLE_EQ(banded[i], plain[i] * (i < 6 ? 1 : 4));
  PanelMaterial even;
  even.least_mass_share = 1;
  const double mean = 0.4 * 0.04 / 9;
  const std::vector<double> evened = node_masses(mesh, even);
  for (std::size_t i = 0; i < 9; ++i) EXPECT_DOUBLE_EQ(evened[i], std::max(mean, plain[i]));
}

TEST(PanelSprings, BadClothIsRefused) {
  const auto complaint = [](auto change) {
    PanelMaterial cloth;
    change(cloth);
    return input_error_of([&] { require_cloth("front", cloth); });
  };
  EXPECT_EQ(complaint([](PanelMaterial&) {}), "");
  EXPECT_EQ(complaint([](PanelMaterial& cloth) { cloth.area_density = 0; }),
            "front: the cloth's area density is 0; give a number above 0");
  EXPECT_EQ(complaint([](PanelMaterial& cloth) { cloth.waistband.height = -1; }),
            "front: the waistband's height is -1; give a number not below 0");
  EXPECT_THAT(complaint([](PanelMaterial& cloth) { cloth.structural.stiffness = -200; }),
              StartsWith("front: the structural stiffness is -200"));
  EXPECT_THAT(
      complaint([](PanelMaterial& cloth) { cloth.shear.damping = std::numeric_limits<double>::infinity(); }),
      HasSubstr("the shear damping is inf"));
}

}  // namespace
}  // namespace mssim
