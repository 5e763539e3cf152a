#include "garment/pattern/garment_build.h"

#include "tests/support/rectangle_piece.h"
#include "tests/support/testing.h"
#include "text/error.h"

namespace mssim {
namespace {

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
  const PanelMaterial cloth{.waistband = {.height = 0.25}};
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
  const std::vector<double> banded = node_masses(mesh, {.waistband = {.height = 0.02}});
  for (std::size_t i = 0; i < 9; ++i) EXPECT_DOUBLE_EQ(banded[i], plain[i] * (i < 6 ? 1 : 4));
  const double mean = 0.4 * 0.04 / 9;
  const std::vector<double> evened = node_masses(mesh, {.least_mass_share = 1});
  for (std::size_t i = 0; i < 9; ++i) EXPECT_DOUBLE_EQ(evened[i], std::max(mean, plain[i]));
}

TEST(PanelSprings, BadClothIsRefused) {
  const auto complaint = [](auto change) {
    PanelMaterial cloth;
    change(cloth);
    return sentence_of<InputError>([&] { require_cloth("front", cloth); });
  };
  EXPECT_EQ(complaint([](PanelMaterial&) {}), "");
  EXPECT_EQ(complaint([](PanelMaterial& cloth) { cloth.area_density = 0; }),
            "front: the cloth's area density is 0; give a number above 0");
  EXPECT_THAT(
      complaint([](PanelMaterial& cloth) { cloth.shear.damping = std::numeric_limits<double>::infinity(); }),
      HasSubstr("the shear damping is inf"));
}

/// A body that is as deep everywhere.
BodyDepth depth_of(double front, double back) {
  return {[=](double) { return front; }, [=](double) { return back; }};
}

/// Panel of 0.3 x 0.6 m from 0.2 m up, x = 0 in its middle.
PanelMesh panel() { return mesh_panel(rectangle_piece("p", 0.3, 0.6, -0.15, 0.2), {25, 31}); }

TEST(Placement, ThePanelIsBentRoundAnUprightCylinder) {
  PanelPlacement placement;
  placement.distance = 0.05;
  placement.radius = 0.2;
  const PanelMesh mesh = panel();
  const std::vector<Vec3d> placed = place_panel("p", mesh, placement, depth_of(0.13, -0.1));
  ASSERT_EQ(placed.size(), mesh.nodes.size());
  for (std::size_t i = 0; i < placed.size(); ++i) {
    EXPECT_EQ(placed[i].y, mesh.nodes[i].y);
    // The cylinder's axis lies 0.2 m behind its foremost line at z = 0.18 m.
    EXPECT_NEAR(std::hypot(placed[i].x, placed[i].z + 0.02), 0.2, 2e-6);
    EXPECT_NEAR(std::atan2(placed[i].x, placed[i].z + 0.02), mesh.nodes[i].x / 0.2, 1e-5);
  }
}

TEST(Placement, BehindTheBodyThePanelIsSeenFromThere) {
  PanelPlacement placement;
  placement.behind = true;
  const PanelMesh mesh = panel();
  const std::vector<Vec3d> placed = place_panel("p", mesh, placement, depth_of(0.13, -0.1));
  for (std::size_t i = 0; i < placed.size(); ++i) {
    EXPECT_LE(mesh.nodes[i].x * placed[i].x, 0);
    EXPECT_LE(placed[i].z, 0.12);
  }
  EXPECT_NEAR(placed[15].z, -0.13, 1e-6);
  EXPECT_NEAR(placed[15].x, 0, 1e-6);
}

TEST(Placement, PanelsStartOutsideACylinderThatStandsInTheMiddle) {
  constexpr double radius = 0.16;
  const PanelMesh mesh = panel();
  for (const bool behind : {false, true})
    for (const double axis : {-0.1, 0.1}) {
      PanelPlacement placement;
      placement.behind = behind;
      placement.axis = [axis](double) { return axis; };
      for (const Vec3d& node : place_panel("p", mesh, placement, depth_of(radius, -radius)))
        EXPECT_GT(std::hypot(node.x, node.z), radius + 0.009);
    }
}

TEST(Placement, TheHalfThatLooksInwardsStaysBeforeTheWholeBody) {
  const PanelMesh mesh = panel();
  PanelPlacement placement;
  placement.axis = [](double) { return 0.1; };
  const std::vector<Vec3d> placed = place_panel("p", mesh, placement, depth_of(0.16, -0.16));
  int inwards = 0;
  for (std::size_t i = 0; i < placed.size(); ++i)
    if (mesh.nodes[i].x < 0) {
      EXPECT_GE(placed[i].z, 0.16 + 0.01 - 1e-6);
      ++inwards;
    }
  EXPECT_GT(inwards, 0);
}

TEST(Placement, ThePanelFollowsTheBodysDepthAndNeverCutsIntoIt) {
  // A step at 0.5 m: the panel begins to stand off 10 cm below it and has done so 0 cm below it.
  const BodyDepth body{[](double y) { return y < 0.5 ? 0.1 : 0.2; }, [](double) { return -0.1; }};
  const PanelMesh mesh = panel();
  const std::vector<Vec3d> placed = place_panel("p", mesh, {}, body);
  EXPECT_LT(placed[mesh.node(0, 15)].y, 0.39);
  EXPECT_GT(placed[mesh.node(mesh.rows - 1, 15)].y, 0.51);
  for (std::size_t row = 0; row < mesh.rows; ++row) {
    const Vec3d& node = placed[mesh.node(row, 15)];
    EXPECT_GE(node.z, body.front(node.y) + 0.03 - 1e-6);
    if (node.y < 0.39) {
      EXPECT_NEAR(node.z, 0.13, 1e-6);
    }
    if (node.y > 0.51) {
      EXPECT_NEAR(node.z, 0.23, 1e-6);
    }
    if (row > 0) {
      EXPECT_GE(node.z, placed[mesh.node(row - 1, 15)].z);
    }
  }
}

TEST(Placement, BadPlacementsAreRefused) {
  const PanelMesh mesh = panel();
  const BodyDepth short_body{
      [](double y) { return y < 0.7 ? 0.1 : std::numeric_limits<double>::quiet_NaN(); },
      [](double) { return -0.1; }};
  EXPECT_THAT(sentence_of<InputError>([&] { place_panel("front", mesh, {}, short_body); }),
              AllOf(StartsWith("front: the body has the depth nan m at the height 0.7"),
                    HasSubstr("give a body that reaches over")));
}

/// Two panels, "a" and "b", whose right and left boundary are to be sewn; b's nodes follow a's.
struct Pair {
  std::vector<GarmentPanel> panels;
  std::vector<PanelMesh> meshes;

  Pair(const PanelGrid& a, const PanelGrid& b, double height_a = 1, double height_b = 1)
      : panels{{"a", a.rows, a.columns, 0, 0}, {"b", b.rows, b.columns, a.rows * a.columns, 0}},
        meshes{mesh_panel(rectangle_piece("a", 1, height_a), a),
               mesh_panel(rectangle_piece("b", 1, height_b), b)} {}

  std::vector<Joint> join(const Seam& seam) const { return join_seam(seam, panels, meshes, 7); }
  std::string complaint(const Seam& seam) const {
    return sentence_of<InputError>([&] { join(seam); });
  }
};

Seam seam_of(SeamStretch first, SeamStretch second) { return {"s", std::move(first), std::move(second)}; }
const Seam whole = seam_of({"a", PanelEdge::right}, {"b", PanelEdge::left});

double total_length(const std::vector<Joint>& joints) {
  double sum = 0;
  for (const Joint& joint : joints) sum += joint.length;
  return sum;
}

TEST(Seams, EqualSidesJoinNodeToNode) {
  const Pair pair({5, 3}, {5, 4});
  const std::vector<Joint> joints = pair.join(whole);
  ASSERT_EQ(joints.size(), 5U);
  for (std::uint32_t i = 0; i < 5; ++i) {
    EXPECT_EQ(joints[i].node, 3 * i + 2);
    EXPECT_EQ(joints[i].edge_first, 15 + 4 * i);
    EXPECT_EQ(joints[i].edge_second, joints[i].edge_first);
    EXPECT_EQ(joints[i].edge_share, 0);
    EXPECT_DOUBLE_EQ(joints[i].length, i == 0 || i == 4 ? 0.125 : 0.25);
    EXPECT_EQ(joints[i].strength, 1);
    EXPECT_EQ(joints[i].seam, 7U);
  }
}

TEST(Seams, TheFinerSideIsJoinedToEdgesOfTheCoarserOne) {
  // Nodes of the finer side at 0, .25, .5, .75, 1; of the coarser at 0, 1/3, 2/3, 1.
  const Pair pair({4, 2}, {5, 2});
  for (const Seam& seam : {whole, seam_of(whole.second, whole.first)}) {
    const std::vector<Joint> joints = pair.join(seam);
    ASSERT_EQ(joints.size(), 5U);
    const std::array<std::uint32_t, 5> first{1, 1, 3, 5, 7}, second{1, 3, 5, 7, 7};
    const std::array<double, 5> fraction{0, 0.75, 0.5, 0.25, 0};
    for (std::uint32_t i = 0; i < 5; ++i) {
      EXPECT_EQ(joints[i].node, 8 + 2 * i);
      EXPECT_EQ(joints[i].edge_first, first[i]);
      EXPECT_EQ(joints[i].edge_second, second[i]);
      EXPECT_NEAR(joints[i].edge_share, fraction[i], 1e-12);
    }
    EXPECT_NEAR(total_length(joints), 1, 1e-12);
  }
}

TEST(Seams, EachNodeOfTheFinerSideIsJoinedOnceAndLengthsSumToTheSeam) {
  const Pair pair({23, 3, {{7, 0.2, 0.4}}}, {57, 2, {{20, 0.5, 0.5}}}, 0.99, 1.01);
  const std::vector<Joint> joints = pair.join(whole);
  std::set<std::uint32_t> nodes;
  for (const Joint& joint : joints) nodes.insert(joint.node);
  EXPECT_EQ(joints.size(), 57U);
  EXPECT_EQ(nodes.size(), 57U);
  EXPECT_NEAR(total_length(joints), 1.01, 1e-12);
  EXPECT_EQ(joints.back().edge_first, joints.back().edge_second);
  // Both sides' places agree in their fraction of the seam.
  const PanelMesh &a = pair.meshes[0], &b = pair.meshes[1];
  for (const Joint& joint : joints) {
    const double y = b.nodes[joint.node - 69].y / 1.01;
    const double other = (1 - joint.edge_share) * a.nodes[joint.edge_first].y +
                         joint.edge_share * a.nodes[joint.edge_second].y;
    EXPECT_NEAR(other / 0.99, y, 0.05 * 0.6 / 15 + 1e-5);  // a twentieth of the longest edge
  }
}

TEST(Seams, AStretchPassedBackwardsTurnsTheSeamRound) {
  const Pair pair({5, 2}, {5, 2});
  const std::vector<Joint> joints =
      pair.join(seam_of({"a", PanelEdge::right, 0, 0.5}, {"b", PanelEdge::left, 1, 0.5}));
  ASSERT_EQ(joints.size(), 3U);
  for (std::uint32_t i = 0; i < 3; ++i) {
    EXPECT_EQ(joints[i].node, 2 * i + 1);
    EXPECT_EQ(joints[i].edge_first, 10 + 2 * (4 - i));
  }
  EXPECT_DOUBLE_EQ(total_length(joints), 0.5);
}

TEST(Seams, TheTwoSidesOfOnePanelMakeATube) {
  const Pair pair({5, 3}, {5, 2});
  const std::vector<Joint> joints = pair.join(seam_of({"a", PanelEdge::right}, {"a", PanelEdge::left}));
  ASSERT_EQ(joints.size(), 5U);
  EXPECT_EQ(joints[4].node, 14U);
  EXPECT_EQ(joints[4].edge_first, 12U);
}

TEST(Seams, VeryDifferentLengthsAreRefused) {
  const Pair pair({5, 2}, {5, 2}, 1, 1.04);
  EXPECT_THAT(pair.complaint(whole),
              AllOf(StartsWith("seam s: the right boundary of a from 0 to 1 is 1 m long"),
                    HasSubstr("1.04 m; give them the same length"), HasSubstr("tolerance of 0.03")));
  Seam tolerant = whole;
  tolerant.tolerance = 0.04;
  EXPECT_EQ(pair.complaint(tolerant), "");
}

TEST(Seams, BadStretchesAreRefused) {
  const Pair pair({5, 2}, {5, 2});
  const auto complaint = [&](const SeamStretch& first) {
    return pair.complaint(seam_of(first, {"b", PanelEdge::left}));
  };
  EXPECT_EQ(complaint({"c", PanelEdge::right}), "seam s: there is no panel c; use one of a, b");
  EXPECT_THAT(
      complaint({"a", PanelEdge::top, 0.5, 0.5}),
      StartsWith("seam s: the top boundary of a from 0.5 to 0.5 is not a valid stretch; give two different"));
  EXPECT_THAT(complaint({"a", PanelEdge::right, 0, 1.1}), HasSubstr("from 0 to 1.1 is not a valid stretch"));
  EXPECT_THAT(complaint({"a", PanelEdge::right, 0.01, 0.1}),
              AllOf(HasSubstr("has fewer than two nodes"), HasSubstr("or give the panel more nodes")));
  EXPECT_THAT(pair.complaint(seam_of({"a", PanelEdge::right}, {"a", PanelEdge::top})),
              AllOf(StartsWith("seam s: "), HasSubstr("share the node 9; use two separate stretches")));
}

}  // namespace
}  // namespace mssim
