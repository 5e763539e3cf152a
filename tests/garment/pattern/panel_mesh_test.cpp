#include "garment/pattern/garment_build.h"
#include "tests/support/rectangle_piece.h"
#include "tests/support/testing.h"
#include "text/error.h"

namespace mssim {
namespace {

/// The parabola y = x^2 from 0 to 1 as a cubic Bezier segment.
Curve parabola() {
  return Curve::bezier(
      std::array{Vec3d{0, 0, 0}, Vec3d{1.0 / 3, 0, 0}, Vec3d{2.0 / 3, 1.0 / 3, 0}, Vec3d{1, 1, 0}});
}

TEST(Curve, APolylineIsMeasuredAlongItsChords) {
  const Curve curve({{0, 0, 0}, {3, 4, 0}, {3, 9, 0}});
  EXPECT_EQ(curve.length(), 10);
  EXPECT_EQ(curve.at(0), (Vec3d{0, 0, 0}));
  EXPECT_EQ(curve.at(0.5), (Vec3d{3, 4, 0}));
  EXPECT_EQ(curve.at(0.75), (Vec3d{3, 6.5, 0}));
  EXPECT_EQ(curve.at(1), (Vec3d{3, 9, 0}));
}

TEST(Curve, ABezierSegmentHasTheArcLengthOfItsParabola) {
  // The integral of sqrt(1 + 4 x^2) from 0 to 1.
  EXPECT_NEAR(parabola().length(), (2 * std::sqrt(5) + std::asinh(2)) / 4, 1e-5);
  const Curve curve = parabola();
  for (const Vec3d& point : curve.points()) EXPECT_NEAR(point.y, point.x * point.x, 1e-15);
}

TEST(Curve, PointsLieByArcLengthHoweverUnevenTheControlPointsAre) {
  const Curve curve =
      Curve::bezier(std::array{Vec3d{0, 0, 0}, Vec3d{0.1, 0, 0}, Vec3d{0.2, 0, 0}, Vec3d{2, 0, 0}});
  EXPECT_NEAR(curve.length(), 2, 1e-14);
  EXPECT_NEAR(curve.at(0.25).x, 0.5, 1e-14);
}

TEST(Curve, AChainOfSegmentsGoesOnFromEndToEnd) {
  const Curve chain = Curve::bezier(std::array{Vec3d{0, 0, 0}, Vec3d{1, 0, 0}, Vec3d{2, 0, 0}, Vec3d{3, 0, 0},
                                               Vec3d{3, 1, 0}, Vec3d{3, 2, 0}, Vec3d{3, 3, 0}});
  EXPECT_NEAR(chain.length(), 6, 1e-14);
  EXPECT_NEAR(length(chain.at(0.5) - Vec3d{3, 0, 0}), 0, 1e-14);
  EXPECT_EQ(chain.points().size(), 2 * Curve::chords + 1);
}

TEST(Curve, MirroredItsXIsTurnedRound) {
  EXPECT_EQ(parabola().mirrored().last(), (Vec3d{-1, 1, 0}));
  EXPECT_EQ(parabola().mirrored().length(), parabola().length());
}

TEST(Curve, WhatIsNoCurveIsRefused) {
  const auto complaint = [](std::vector<Vec3d> points) {
    return sentence_of<InputError>([&] { Curve{points}; });
  };
  EXPECT_THAT(complaint({{0, 0, 0}}), HasSubstr("has 1 point; give two or more points"));
  EXPECT_THAT(complaint({{0, 0, 0}, {1, 2, 0}, {1, 2, 0}}),
              AllOf(HasSubstr("point 2 of a boundary curve, (1, 2, 0), "), HasSubstr("remove one of them")));
  EXPECT_THAT(complaint({{0, 0, 0}, {1, 2, 3}}),
              HasSubstr("(1, 2, 3), does not lie in the plane of the pattern"));
  EXPECT_THAT(complaint({{0, 0, 0}, {std::numeric_limits<double>::infinity(), 2, 0}}), HasSubstr("finite"));
  EXPECT_THAT(sentence_of<InputError>([] {
                Curve::bezier(std::array{Vec3d{0, 0, 0}, Vec3d{1, 0, 0}, Vec3d{2, 0, 0}});
              }),
              HasSubstr("has 3 points; give 4, 7, 10 or another 3 n + 1 points"));
}

/// Nodes are rounded to micrometres.
constexpr double rounding = 0.5e-6 * 1.001;

void expect_node(const PanelMesh& mesh, std::size_t row, std::size_t column, double x, double y) {
  const Vec3d& node = mesh.nodes[mesh.node(row, column)];
  EXPECT_NEAR(node.x, x, rounding) << "row " << row << ", column " << column;
  EXPECT_NEAR(node.y, y, rounding) << "row " << row << ", column " << column;
  EXPECT_EQ(node.z, 0);
}

std::string complaint(const PatternPiece& piece, const PanelGrid& grid = {4, 4}) {
  return sentence_of<InputError>([&] { mesh_panel(piece, grid); });
}

TEST(PanelMesh, ATrapezoidIsTheBilinearBlendOfItsCorners) {
  const Vec3d a{0, 0, 0}, b{1, 0, 0}, c{0.25, 0.5, 0}, d{0.75, 0.5, 0};
  const PanelMesh mesh =
      mesh_panel({"p", Curve({a, b}), Curve({c, d}), Curve({a, c}), Curve({b, d})}, {5, 9});
  for (std::size_t row = 0; row < 5; ++row)
    for (std::size_t column = 0; column < 9; ++column) {
      const double u = static_cast<double>(column) / 8, v = static_cast<double>(row) / 4;
      expect_node(mesh, row, column, 0.25 * v + u * (1 - 0.5 * v), 0.5 * v);
    }
}

TEST(PanelMesh, ABentBoundaryFadesLinearlyTowardsTheOppositeOne) {
  PatternPiece piece = rectangle_piece("p", 1, 1);
  piece.bottom = Curve({{0, 0, 0}, {0.5, -0.3, 0}, {1, 0, 0}});
  const PanelMesh mesh = mesh_panel(piece, {5, 5});
  for (std::size_t row = 0; row < 5; ++row) {
    const double v = static_cast<double>(row) / 4;
    expect_node(mesh, row, 2, 0.5, v - (1 - v) * 0.3);
    expect_node(mesh, row, 1, 0.25, v - (1 - v) * 0.15);
  }
}

TEST(PanelMesh, RowsEndWhereTheyAreTold) {
  const PanelMesh mesh = mesh_panel(rectangle_piece("p", 1, 1), {6, 4, {{2, 0.5, 0.6}}});
  expect_node(mesh, 2, 0, 0, 0.5);
  expect_node(mesh, 2, 3, 1, 0.6);
  expect_node(mesh, 1, 0, 0, 0.25);
  expect_node(mesh, 5 - 1, 3, 1, 0.6 + 2.0 / 3 * 0.4);
  expect_node(mesh, 0, 1, 1.0 / 3, 0);
  EXPECT_THAT(mesh.arcs_on(PanelEdge::left), ElementsAre(0, 0.25, 0.5, testing::DoubleEq(0.5 + 0.5 / 3),
                                                         testing::DoubleEq(0.5 + 1.0 / 3), 1));
}

TEST(PanelMesh, AnEdgesNodesStandInTheOrderOfItsBoundary) {
  const PanelMesh mesh = mesh_panel(rectangle_piece("p", 1, 1), {3, 4});
  EXPECT_THAT(mesh.edge_nodes(PanelEdge::bottom), ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(mesh.edge_nodes(PanelEdge::top), ElementsAre(8, 9, 10, 11));
  EXPECT_THAT(mesh.edge_nodes(PanelEdge::left), ElementsAre(0, 4, 8));
  EXPECT_THAT(mesh.edge_nodes(PanelEdge::right), ElementsAre(3, 7, 11));
}

TEST(PanelMesh, CornersMustMeetToATenthOfAMillimetre) {
  PatternPiece piece = rectangle_piece("front", 1, 1);
  piece.top = Curve({{0.00009, 1, 0}, {1, 1, 0}});
  EXPECT_EQ(complaint(piece), "");
  piece.top = Curve({{0, 1, 0}, {1.00011, 1, 0}});
  EXPECT_THAT(complaint(piece),
              AllOf(StartsWith("front: at the top right corner the top boundary ends at (1.00011, 1, 0)"),
                    HasSubstr("make them meet within 0.1 mm")));
}

TEST(PanelMesh, BoundariesThatMeetElsewhereAreRefused) {
  PatternPiece crossing = rectangle_piece("front", 1, 1);
  crossing.left = Curve({{0, 0, 0}, {1.2, 0.5, 0}, {0, 1, 0}});
  EXPECT_THAT(complaint(crossing), AllOf(StartsWith("front: the right and the left boundary meet near ("),
                                         HasSubstr("draw them so that they neither cross nor touch")));
  PatternPiece looped = rectangle_piece("front", 1, 1);
  looped.top = Curve({{0, 1, 0}, {0.6, 1.2, 0}, {0.6, 1.4, 0}, {0.4, 1.4, 0}, {0.4, 1.2, 0}, {1, 1, 0}});
  EXPECT_THAT(complaint(looped), StartsWith("front: the top boundary meets itself near ("));
  PatternPiece touching = rectangle_piece("front", 1, 1);
  touching.bottom = Curve({{0, 0, 0}, {0.5, 1, 0}, {1, 0, 0}});
  EXPECT_THAT(complaint(touching), HasSubstr("the bottom and the top boundary meet"));
}

TEST(PanelMesh, CellsThatFoldOverAreRefused) {
  // Where the lower boundary runs along the sides of its pocket it makes no way to the right, and the left
  // one, which stands far in, leaves the columns no room at half the height.
  PatternPiece piece = rectangle_piece("front", 1, 1);
  piece.left = Curve({{0, 0, 0}, {0.9, 0.45, 0}, {0.9, 0.55, 0}, {0, 1, 0}});
  piece.bottom = Curve({{0, 0, 0}, {0.4, 0, 0}, {0.4, -2, 0}, {0.6, -2, 0}, {0.6, 0, 0}, {1, 0, 0}});
  EXPECT_THAT(complaint(piece, {30, 30}),
              AllOf(StartsWith("front: the cell in row "), HasSubstr(" folds over at ("),
                    HasSubstr("straighten the boundaries there or end the grid lines")));
}

TEST(PanelMesh, APieceDrawnFromBehindFoldsOver) {
  const Vec3d a{0, 0, 0}, b{1, 0, 0}, c{0, 1, 0}, d{1, 1, 0};
  const PatternPiece piece{"front", Curve({b, a}), Curve({d, c}), Curve({b, d}), Curve({a, c})};
  EXPECT_THAT(complaint(piece), HasSubstr("row 0 and column 0 folds over at (1, 0, 0)"));
}

TEST(PanelMesh, BadGridsAreRefused) {
  const PatternPiece piece = rectangle_piece("front", 1, 1);
  EXPECT_THAT(complaint(piece, {4, 1}), HasSubstr("1 columns of nodes; give a number from 2 to 10000"));
  EXPECT_THAT(
      complaint(piece, {4, 4, {{3, 0.5, 0.5}}}),
      AllOf(StartsWith("front: row 3 cannot end at the fractions 0.5 and 0.5"), HasSubstr("from 1 to 2")));
  EXPECT_THAT(complaint(piece, {9, 4, {{2, 0.5, 0.5}, {3, 0.6, 0.4}}}),
              StartsWith("front: row 3 cannot end"));
  EXPECT_THAT(complaint(piece, {9, 4, {{2, 0.5, 1}}}), StartsWith("front: row 2 cannot end"));
}

}  // namespace
}  // namespace mssim
