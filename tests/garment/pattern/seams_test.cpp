#include <gmock/gmock.h>

#include <set>

#include "garment/pattern/garment_build.h"
#include "tests/support/mesh_fixture.h"
#include "tests/support/rectangle_piece.h"

namespace mssim {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

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
    return input_error_of([&] { join(seam); });
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
  EXPECT_EQ(pair.complaint(whole),
            "seam s: the right boundary of a from 0 to 1 is 1 m long and the left boundary of b from 0 to 1 "
            "1.04 m; "
            "give them the same length or raise the seam's tolerance of 0.03");
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
