#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "garment/pattern/garment_build.h"
#include "tests/support/mesh_fixture.h"
#include "tests/support/rectangle_piece.h"

namespace mssim {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

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

TEST(Placement, TheOutsideLooksAwayFromTheBody) {
  const PanelMesh mesh = panel();
  for (const bool behind : {false, true}) {
    PanelPlacement placement;
    placement.behind = behind;
    const std::vector<Vec3d> placed = place_panel("p", mesh, placement, depth_of(0.13, -0.1));
    const std::size_t middle = mesh.node(12, 15);
    const Vec3d normal =
        cross(placed[middle + 1] - placed[middle], placed[middle + mesh.columns] - placed[middle]);
    EXPECT_GT(normal.z * (behind ? -1 : 1), 0);
  }
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
  EXPECT_THAT(input_error_of([&] { place_panel("front", mesh, {}, short_body); }),
              AllOf(StartsWith("front: the body has the depth nan m at the height 0.7"),
                    HasSubstr("give a body that reaches along the whole panel")));
  PanelPlacement flat;
  flat.radius = 0;
  EXPECT_THAT(input_error_of([&] { place_panel("front", mesh, flat, depth_of(0.1, -0.1)); }),
              AllOf(StartsWith("front: it cannot be placed 0.03 m from the body, bent with a radius of 0 m"),
                    HasSubstr("give positive lengths")));
}

}  // namespace
}  // namespace mssim
