#include "garment/layers/cloth_contacts.h"

#include <map>

#include "geometry/triangle_tree.h"
#include "tests/support/cloth_layers_fixture.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

TEST(NearestPoint, IsFoundOnTheInsideTheSidesAndTheCorners) {
  const Vec3<float> a{0, 0, 0}, b{4, 0, 0}, c{0, 4, 0};
  const auto expect = [&](const Vec3<float>& p, float of_a, float of_b, float of_c, float squared) {
    SCOPED_TRACE(std::to_string(p.x) + ", " + std::to_string(p.y));
    const NearestPoint nearest = nearest_point(p, a, b, c);
    EXPECT_THAT(nearest.weight, ElementsAre(of_a, of_b, of_c));
    EXPECT_EQ(nearest.distance_squared(), squared);
  };
  expect({1, 1, 2}, 0.5F, 0.25F, 0.25F, 4);
  expect({1, 2, 0}, 0.25F, 0.25F, 0.5F, 0);
  expect({1, -2, 1}, 0.75F, 0.25F, 0, 5);
  expect({-3, 1, 0}, 0.75F, 0, 0.25F, 9);
  expect({3, 3, 1}, 0, 0.5F, 0.5F, 3);
  expect({-1, -1, -1}, 1, 0, 0, 3);
  expect({6, -1, 0}, 0, 1, 0, 5);
  expect({-1, 5, 0}, 0, 0, 1, 2);
}

TEST(NearestPoint, IsOnTheTriangleEvenWhereThatHasNoArea) {
  const Vec3<float> a{1, 2, 3}, b{2, 2, 3}, p{0.5F, 3, 3};
  for (const auto& nearest : {nearest_point(p, a, a, a), nearest_point(p, a, b, b), nearest_point(p, a, a, b),
                              nearest_point(p, a, b, a), nearest_point(p, b, a, {3, 2, 3})}) {
    EXPECT_EQ(nearest.distance_squared(), 1.25F);  // that of a
    EXPECT_EQ(nearest.weight[0] + nearest.weight[1] + nearest.weight[2], 1);
  }
}

/// What stands near a node, found from all triangles, in double precision.
struct BruteForce {
  double distance = std::numeric_limits<double>::infinity();  // m, to the other panel
  bool inside = false;                                        // of a triangle, not on its edges
  bool border = false;                                        // of the panel
  double gap = 0;                                             // m, where `inside`

  using Corners = std::array<std::array<std::uint32_t, 2>, 3>;  // row and column

  static bool on_border(const GarmentPanel& panel, const std::array<std::uint32_t, 2>& a,
                        const std::array<std::uint32_t, 2>& b) {
    return (a[0] == b[0] && (a[0] == 0 || a[0] + 1 == panel.rows)) ||
           (a[1] == b[1] && (a[1] == 0 || a[1] + 1 == panel.columns));
  }
  void compare(const LayeredCloth& cloth, const Vec3d& p, const GarmentPanel& panel, const Corners& corners) {
    const auto at = [&](std::size_t i) { return cloth.point(panel.node(corners[i][0], corners[i][1])); };
    const Vec3d area = cross(at(1) - at(0), at(2) - at(0));
    const double whole = dot(area, area);
    const double of_0 = dot(area, cross(at(1) - p, at(2) - p)) / whole;
    const double of_1 = dot(area, cross(at(2) - p, at(0) - p)) / whole;
    if (of_0 > 0 && of_1 > 0 && of_0 + of_1 < 1) {
      const double height = dot(p - at(0), area) / std::sqrt(whole);
      if (std::abs(height) < distance) *this = {std::abs(height), true, false, height};
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3;
      const Vec3d side = at(j) - at(i);
      const double fraction = std::clamp(dot(p - at(i), side) / dot(side, side), 0.0, 1.0);
      const double far = length(p - at(i) - fraction * side);
      if (far < distance - 1e-12)
        *this = {far, false, on_border(panel, corners[fraction == 1 ? j : i], corners[fraction == 0 ? i : j]),
                 0};
    }
  }
  static BruteForce of(const LayeredCloth& cloth, std::uint32_t node, const GarmentPanel& other) {
    BruteForce nearest;
    for (std::uint32_t row = 0; row + 1 < other.rows; ++row) {
      for (std::uint32_t column = 0; column + 1 < other.columns; ++column) {
        const Corners lower{{{row, column}, {row, column + 1}, {row + 1, column + 1}}};
        const Corners upper{{{row, column}, {row + 1, column + 1}, {row + 1, column}}};
        nearest.compare(cloth, cloth.point(node), other, lower);
        nearest.compare(cloth, cloth.point(node), other, upper);
      }
    }
    return nearest;
  }
};

constexpr double search_reach = 0.004;

/// Compares the contacts of the nodes of one panel with those that the brute force finds; their number.
int expect_like_brute_force(const LayeredCloth& cloth, const std::map<std::uint32_t, ClothContact>& found,
                            const GarmentPanel& panel, const GarmentPanel& other, double outward) {
  int contacts = 0;
  for (std::uint32_t node = panel.first_node; node < panel.first_node + panel.nodes(); ++node) {
    const BruteForce expected = BruteForce::of(cloth, node, other);
    const auto contact = found.find(node);
    if (std::abs(expected.distance - search_reach) < 1e-6) continue;  // single precision may say either
    if (contact == found.end()) {
      // Beyond a border, on its wrong side, a node is none.
      EXPECT_TRUE(expected.distance > search_reach || expected.border) << node << ": " << expected.distance;
      continue;
    }
    ++contacts;
    EXPECT_NEAR(std::abs(contact->second.gap), expected.distance, 1e-6) << node;
    if (expected.inside && expected.distance > 1e-5) {
      EXPECT_NEAR(contact->second.gap, outward * expected.gap, 2e-6) << node;
    }
    EXPECT_NEAR(length(vec3_cast<double>(contact->second.normal)), 1, 1e-5) << node;
    Vec3d difference = cloth.point(node);
    for (std::size_t i = 0; i < 3; ++i)
      difference -= double{contact->second.weight[i]} * cloth.point(contact->second.triangle[i]);
    EXPECT_NEAR(length(difference - double{contact->second.gap} * vec3_cast<double>(contact->second.normal)),
                0, 1e-6)
        << node;
  }
  return contacts;
}

TEST(ClothContactSearch, FindsWhatBruteForceFindsBetweenFoldedSheets) {
  std::mt19937 random(1);
  using Sizes = std::array<std::uint32_t, 4>;
  int contacts = 0;
  for (const auto& [inner_rows, inner_columns, outer_rows, outer_columns] :
       {Sizes{20, 20, 20, 20}, Sizes{3, 40, 17, 9}, Sizes{2, 30, 30, 2}, Sizes{2, 2, 23, 19},
        Sizes{31, 5, 2, 2}, Sizes{6, 6, 5, 5}, Sizes{10, 9, 9, 10}}) {
    for (int i = 0; i < 4; ++i) {
      const LayeredCloth cloth = folded_sheets(random, inner_rows, inner_columns, outer_rows, outer_columns);
      ClothContactSearch search(cloth.garment, search_reach, 2);
      std::map<std::uint32_t, ClothContact> found;
      for (const ClothContact& contact : search.find(cloth.coordinates()))
        EXPECT_TRUE(found.emplace(contact.node, contact).second) << contact.node << " twice";
      const auto &inner = cloth.garment.panels[0], &outer = cloth.garment.panels[1];
      contacts += expect_like_brute_force(cloth, found, inner, outer, -1);
      contacts += expect_like_brute_force(cloth, found, outer, inner, 1);
    }
  }
  EXPECT_GT(contacts, 800);
}

TEST(ClothContactSearch, FindsTheSameToTheLastBitWithAnyNumberOfThreads) {
  std::mt19937 random(2);
  for (int i = 0; i < 5; ++i) {
    LayeredCloth cloth = folded_sheets(random, 30, 40, 50, 25);
    cloth.add(2, 20, 21, level(0.002, 0.01));
    ASSERT_EQ(layer_pairs(cloth.garment).size(), 3U);
    ClothContactSearch alone(cloth.garment, search_reach, 1);
    const auto contacts = alone.find(cloth.coordinates());
    const std::vector<ClothContact> expected(contacts.begin(), contacts.end());
    EXPECT_GT(expected.size(), 300U);
    for (const int threads : {1, 2, 3, 4}) {
      ClothContactSearch search(cloth.garment, search_reach, threads);
      for (int again = 0; again < 3; ++again)
        EXPECT_TRUE(std::ranges::equal(search.find(cloth.coordinates()), expected)) << threads;
    }
  }
}

/// A level panel and a single outer cell of which only the first node is near it.
LayeredCloth level_and_node(const Vec3d& node) {
  LayeredCloth cloth;
  cloth.add(0, 3, 3, level(0, 1));
  cloth.add(1, 2, 2, [&](double row, double column) { return node + Vec3d{0, 9 * (row + column), 0}; });
  return cloth;
}

std::vector<ClothContact> contacts_of(const LayeredCloth& cloth, double within = 0.1) {
  ClothContactSearch search(cloth.garment, within, 1);
  const auto found = search.find(cloth.coordinates());
  return {found.begin(), found.end()};
}

TEST(ClothContactSearch, TellsTheRightSideByTheNormal) {
  for (const double height : {0.0625, -0.0625}) {
    SCOPED_TRACE(height);
    const auto contacts = contacts_of(level_and_node({0.75, height, -0.25}));
    ASSERT_EQ(contacts.size(), 1U);
    EXPECT_EQ(contacts[0].node, 9U);
    EXPECT_THAT(contacts[0].triangle, ElementsAre(0, 1, 4));
    EXPECT_THAT(contacts[0].weight, ElementsAre(0.25F, 0.5F, 0.25F));
    EXPECT_EQ(contacts[0].gap, static_cast<float>(height));
    EXPECT_EQ(contacts[0].normal, (Vec3<float>{0, 1, 0}));
  }
}

TEST(ClothContactSearch, HoldsInnerNodesOnTheInnerSideOfTheOuterPanel) {
  LayeredCloth cloth = level_and_node({0.75, 0.0625, -0.25});
  cloth.garment.panels[0].layer = 2;  // the node is below the outer panel's normal no more
  EXPECT_THAT(layer_pairs(cloth.garment), ElementsAre(PanelPair{1, 0}));
  auto contacts = contacts_of(cloth);
  ASSERT_EQ(contacts.size(), 1U);
  EXPECT_EQ(contacts[0].gap, -0.0625F);
  EXPECT_EQ(contacts[0].normal, (Vec3<float>{0, -1, 0}));
}

TEST(ClothContactSearch, TakesABorderForARimOnTheRightSideAndForNothingOnTheWrongOne) {
  const auto above = contacts_of(level_and_node({2.03, 0.04, -0.5}));
  ASSERT_EQ(above.size(), 1U);
  EXPECT_NEAR(above[0].gap, 0.05, 1e-6);
  EXPECT_NEAR(above[0].normal.x, 0.6, 1e-6);
  EXPECT_NEAR(above[0].normal.y, 0.8, 1e-6);
  for (const Vec3d& beyond : {Vec3d{2.03, 0, -0.5}, {-0.03, 0, -0.5}, {0.5, 0, 0.03}, {0.5, 0, -2.03}}) {
    EXPECT_EQ(contacts_of(level_and_node(beyond + Vec3d{0, 0.04, 0})).size(), 1U)
        << beyond.x << ' ' << beyond.z;
    EXPECT_EQ(contacts_of(level_and_node(beyond - Vec3d{0, 0.04, 0})).size(), 0U)
        << beyond.x << ' ' << beyond.z;
  }
  EXPECT_EQ(contacts_of(level_and_node({1.97, -0.04, -0.5})).size(), 1U);
}

TEST(ClothContactSearch, KnowsTheSideAtTheEdgeOfASharpFold) {
  // A roof whose ridge is a row of nodes, and a node to which the ridge is nearest: it is outside, though it
  // stands below the plane of one of the two slopes, which are equally near.
  for (const double z : {0.05, -0.05}) {
    SCOPED_TRACE(z);
    LayeredCloth cloth;
    cloth.add(0, 3, 3, [](double row, double column) {
      return Vec3d{column, row == 1 ? 1.0 : 0.0, 0.2 - 0.2 * row};
    });
    cloth.add(1, 2, 2, [&](double row, double column) { return Vec3d{0.5, 1.02 + 9 * (row + column), z}; });
    const auto contacts = contacts_of(cloth);
    ASSERT_EQ(contacts.size(), 1U);
    EXPECT_NEAR(contacts[0].gap, std::hypot(0.02, 0.05), 1e-6);
    EXPECT_NEAR(contacts[0].normal.z, z / std::hypot(0.02, 0.05), 1e-5);
  }
}

TEST(ClothContactSearch, ForgetsWhatItFoundBefore) {
  LayeredCloth cloth = level_and_node({0.75, 0.0625, -0.25});
  ClothContactSearch search(cloth.garment, 0.1, 1);
  EXPECT_EQ(search.find(cloth.coordinates()).size(), 1U);
  cloth.position[1][9] = 0.5F;
  EXPECT_EQ(search.find(cloth.coordinates()).size(), 0U);
  cloth.position[1][9] = 0.09F;
  EXPECT_EQ(search.find(cloth.coordinates()).size(), 1U);
}

TEST(ClothContactSearch, FindsANodeOnTheTriangleItselfAndNoneThatIsNowhere) {
  auto contacts = contacts_of(level_and_node({0.75, 0, -0.25}));
  ASSERT_EQ(contacts.size(), 1U);
  EXPECT_EQ(contacts[0].gap, 0);
  EXPECT_EQ(contacts[0].normal, (Vec3<float>{0, 1, 0}));
  LayeredCloth cloth = level_and_node({0.75, 0, -0.25});
  cloth.position[1][9] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(contacts_of(cloth).size(), 0U);
}

TEST(LayerPairs, AreThoseOfDifferentLayers) {
  Garment garment;
  for (const std::uint32_t layer : {1U, 0U, 0U, 1U})
    garment.panels.push_back({"", 2, 2, static_cast<std::uint32_t>(4 * garment.panels.size()), layer});
  EXPECT_THAT(layer_pairs(garment),
              ElementsAre(PanelPair{1, 0}, PanelPair{1, 3}, PanelPair{2, 0}, PanelPair{2, 3}));
}

/// A level unit square grid of cells, and an upright sheet of one cell across it at an x, from one z to the
/// next (z is -row of the level sheet).
LayeredCloth level_and_upright(std::uint32_t cells, double x, double z_from, double z_to) {
  LayeredCloth cloth;
  cloth.add(0, cells + 1, cells + 1, level(0, 1));
  cloth.add(1, 2, 2, [=](double row, double column) {
    return Vec3d{x, row == 0 ? -1.0 : 1.0, column == 0 ? z_from : z_to};
  });
  return cloth;
}

TEST(CountCrossings, CountsEdgesThroughTriangles) {
  // The upright sheet's two sides and its diagonal go through the level one, whose diagonal goes through it.
  EXPECT_EQ(crossings(level_and_upright(1, 0.4, -0.3, -0.6)), 3U + 1U);
  // Without the level sheet's diagonal, which passes at z = -0.4.
  EXPECT_EQ(crossings(level_and_upright(1, 0.4, -0.5, -0.6)), 3U);
  // Half of it inside: its side at z = -0.6 and the level sheet's border at z = -1. Its diagonal passes the
  // level of the sheet at z = -0.9.
  EXPECT_EQ(crossings(level_and_upright(1, 0.4, -0.6, -1.2)), 2U + 1U);
}

TEST(CountCrossings, CountsNothingThatEndsAtASeamOfTheTwoPanels) {
  // Edges of a row of the outer sheet run through the inner one, in each of its columns.
  LayeredCloth cloth;
  cloth.add(0, 5, 5, level(0, 1));
  cloth.add(1, 2, 5, [](double row, double column) { return Vec3d{column + 0.3, row - 0.5, -1.4}; });
  const std::size_t all = crossings(cloth);
  Joint joint{.node = cloth.garment.panels[1].node(0, 4), .edge_first = 4, .edge_second = 4};
  cloth.garment.joints.push_back(joint);
  const std::size_t beside_the_seam = crossings(cloth);
  EXPECT_LT(beside_the_seam, all);
  EXPECT_GT(beside_the_seam, 0U);
  for (std::uint32_t column = 0; column < 4; ++column) {
    joint.node = cloth.garment.panels[1].node(0, column);
    cloth.garment.joints.push_back(joint);
  }
  EXPECT_EQ(crossings(cloth), 0U);
  for (Joint& within : cloth.garment.joints) within.edge_first = within.edge_second = within.node;
  EXPECT_EQ(crossings(cloth), all) << "no seam of the two";
}

TEST(CountCrossings, FindsNoneBetweenSheetsThatAreApart) {
  EXPECT_EQ(crossings(level_and_upright(1, 1.001, -0.3, -0.6)), 0U);
  LayeredCloth parallel;
  parallel.add(0, 4, 5, level(0, 1));
  parallel.add(1, 4, 5, level(1e-12, 1));
  EXPECT_EQ(crossings(parallel), 0U);
  LayeredCloth interlaced;  // their boxes overlap, and they do not
  interlaced.add(0, 5, 5, [](double row, double column) { return Vec3d{column, column, -row}; });
  interlaced.add(1, 5, 5, [](double row, double column) { return Vec3d{column, column + 0.01, -row}; });
  EXPECT_EQ(crossings(interlaced), 0U);
}

TEST(CountCrossings, CountsAnEdgeThroughASharedSideOnce) {
  // The upright sheet ends on a diagonal, far beyond the other border. Rows of the level sheet at z = -2, -3
  // and -4 and diagonals at -2.5 and -3.5 run through it; its side meets the diagonal at -1.5, which is one
  // crossing, and that diagonal its side, which is one or none.
  EXPECT_THAT(crossings(level_and_upright(4, 1.5, -1.5, -100)), testing::AnyOf(5U + 1U, 5U + 2U));
}

TEST(CountCrossings, CountsTheSameWhicheverWayItIsAsked) {
  std::mt19937 random(5);
  std::size_t all = 0;
  for (int i = 0; i < 20; ++i) {
    const LayeredCloth cloth = folded_sheets(random, 7, 12, 10, 5);
    const auto points = cloth.points();
    const auto &first = cloth.garment.panels[0], &second = cloth.garment.panels[1];
    const std::size_t count = count_crossings(first, second, points);
    EXPECT_EQ(count_crossings(second, first, points), count);
    auto turned = points;  // another axis to sort by
    for (Vec3d& point : turned) point = {point.y, point.z, point.x};
    EXPECT_EQ(count_crossings(first, second, turned), count);
    all += count;
  }
  EXPECT_GT(all, 100U);
}

}  // namespace
}  // namespace mssim
