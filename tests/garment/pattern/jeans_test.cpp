#include "garment/pattern/jeans.h"

#include "model/system.h"
#include "tests/support/garment_system.h"
#include "tests/support/testing.h"
#include "text/error.h"

namespace mssim {
namespace {

/// A body to try jeans on, in formulas: an upright trunk of elliptic sections from the crotch up and two legs
/// of elliptic sections below, which part by a centimetre at the crotch.
struct JeansBody {
  double hip = 0.98;  ///< m, girth at 0.86 m; all else is in proportion

  static constexpr double crotch = 0.768;

  double scale() const { return hip / 0.98; }
  /// As of the reference body: 0.98 m at the hip, 0.88 at 0.95 m, 0.74 at the waist, and level at the hip.
  double girth(double y) const {
    if (y <= 0.86) return hip;
    const double t = (std::min(y, 1.04) - 0.86) / 0.18;
    return scale() * (0.98 - 0.24 * t * t * (1.8 - 0.8 * t));
  }
  /// Half width and half depth of the trunk, whose girth is 5.43 half widths where depth is 0.72 of width.
  double trunk_width(double y) const { return girth(y) / 5.43; }
  double trunk_depth(double y) const { return 0.72 * trunk_width(y); }
  double leg_x(double y) const {
    return (0.09 + 0.035 * (crotch - std::min(y, crotch)) / crotch) * std::max(1.0, scale());
  }
  double leg_radius(double y) const { return scale() * (0.04 + 0.045 * std::min(y, crotch) / crotch); }
  double depth(double y) const { return y >= crotch ? trunk_depth(y) : leg_radius(y); }

  bool holds(const Vec3d& p) const {
    const auto in_ellipse = [](double x, double z, double a, double b) {
      return x * x / (a * a) + z * z / (b * b) < 1;
    };
    if (p.y >= crotch) return in_ellipse(p.x, p.z, trunk_width(p.y), trunk_depth(p.y));
    const double radius = leg_radius(p.y);
    return in_ellipse(std::abs(p.x) - leg_x(p.y), p.z, radius, radius);
  }

  JeansMeasures measures() const {
    JeansMeasures measures;
    measures.girth = [body = *this](double y) { return body.girth(y); };
    return measures;
  }
  BodyDepth depths() const {
    return {[body = *this](double y) { return body.depth(y); },
            [body = *this](double y) { return -body.depth(y); }};
  }
  std::function<double(double)> leg_axis() const {
    return [body = *this](double y) { return body.leg_x(y) + 0.01; };
  }
  GarmentPattern pattern(std::uint32_t nodes, const PanelMaterial& cloth = {}) const {
    return jeans_pattern(measures(), nodes, cloth, leg_axis());
  }
};

constexpr std::array hips{0.88, 0.98, 1.15};
constexpr std::array<std::uint32_t, 6> node_counts{1'000, 2'000, 4'000, 8'000, 16'000, 64'000};

/// x at which a curve that rises all the way passes a height.
double x_at(const Curve& curve, double y) {
  const auto& points = curve.points();
  for (std::size_t i = 1; i < points.size(); ++i)
    if (points[i].y >= y) {
      const double fraction = (y - points[i - 1].y) / (points[i].y - points[i - 1].y);
      return points[i - 1].x + fraction * (points[i].x - points[i - 1].x);
    }
  return points.back().x;
}

/// Around both legs at a height above the thighs, m.
double width_at(const JeansDraft& draft, double y) {
  double width = 0;
  for (const JeansOutline* half : {&draft.front, &draft.back})
    width += x_at(half->centre, y) - x_at(half->outer, y);
  return 2 * width;
}

/// The largest angle between two successive chords, rad.
double sharpest_turn(const Curve& curve) {
  double sharpest = 0;
  const auto& points = curve.points();
  for (std::size_t i = 2; i < points.size(); ++i) {
    const Vec3d before = points[i - 1] - points[i - 2], after = points[i] - points[i - 1];
    sharpest = std::max(sharpest, std::abs(std::atan2(cross(before, after).z, dot(before, after))));
  }
  return sharpest;
}

System build_for(const JeansBody& body, std::uint32_t nodes, const PanelMaterial& cloth = {}) {
  return build_garment(body.pattern(nodes, cloth), body.depths());
}

TEST(JeansDraft, SeamsFitTogether) {
  for (const double hip : hips) {
    const JeansDraft draft = draft_jeans(JeansBody{hip}.measures());
    EXPECT_NEAR(draft.front.inseam.length(), draft.back.inseam.length(), 1e-4) << hip;
    EXPECT_NEAR(draft.front.outer.length() / draft.back.outer.length(), 1, 0.01) << hip;
    EXPECT_NEAR(draft.front.hem.length(), 0.36 / 2 - 0.007, 1e-15);
    EXPECT_NEAR(draft.back.hem.length(), 0.36 / 2 + 0.007, 1e-15);
  }
}

TEST(JeansDraft, WaistAndHipAreTheBodysWithOffsetAndEase) {
  for (const double hip : hips) {
    const JeansBody body{hip};
    const JeansMeasures measures = body.measures();
    const JeansDraft draft = draft_jeans(measures);
    const double offset = 2 * std::numbers::pi * measures.body_offset;
    EXPECT_NEAR(2 * (draft.front.waist.length() + draft.back.waist.length()),
                0.994 * body.girth(measures.waist_height) + offset + measures.waist_ease, 1e-4);
    // Between waist and hip the side is the smooth curve that comes nearest.
    for (double y = 0.861; y < 0.99; y += 0.01) {
      const double fraction = (y - measures.hip_height) / (measures.waist_height - measures.hip_height);
      // The cloth is stretched by 3.1 % around the hip and by 0.6 % around the waist.
      const double wanted = body.girth(y) * (0.969 + 0.025 * fraction);
      EXPECT_NEAR(width_at(draft, y), wanted + offset + fraction * measures.waist_ease, 0.015)
          << hip << " at " << y;
    }
  }
}

TEST(JeansDraft, TheThighIsTheBodysWithOffsetAndEase) {
  for (const double ease : {0.0, 0.02}) {
    JeansMeasures measures = JeansBody{}.measures();
    measures.thigh_ease = ease;
    const JeansDraft draft = draft_jeans(measures);
    // The centre seams stand upright up to 75 mm in front, and 90 mm behind, over the crotch line, which is
    // 30 mm below the crotch; the thigh is measured 10 mm below it.
    const double width = x_at(draft.front.centre, 0.738 + 0.075) + x_at(draft.back.centre, 0.738 + 0.09) -
                         x_at(draft.front.outer, 0.758) - x_at(draft.back.outer, 0.758);
    EXPECT_NEAR(2 * width, 0.969 * 0.98 + 2 * std::numbers::pi * 0.004 + ease, 1e-4) << ease;
  }
}

TEST(JeansDraft, TheSideIsSmoothFromKneeToWaist) {
  for (const double hip : hips)
    for (const std::optional<double> thigh_ease : {std::optional<double>(), {0.0}, {0.02}}) {
      JeansMeasures measures = JeansBody{hip}.measures();
      measures.thigh_ease = thigh_ease;
      const JeansDraft draft = draft_jeans(measures);
      for (const JeansOutline* half : {&draft.front, &draft.back}) {
        EXPECT_LT(sharpest_turn(half->outer), 0.02) << hip << ' ' << thigh_ease.value_or(-1);
        EXPECT_LT(sharpest_turn(half->inseam), 0.02) << hip;
        EXPECT_LT(sharpest_turn(half->centre), 0.05) << hip;
      }
    }
}

TEST(JeansDraft, EaseMakesTheJeansWiderByItsAmount) {
  const JeansBody body;
  JeansMeasures wide = body.measures();
  wide.hip_ease += 0.06;
  // The centre seam's slant is the waist's, and takes its part of it.
  EXPECT_NEAR(width_at(draft_jeans(wide), 0.86) - width_at(draft_jeans(body.measures()), 0.86), 0.06, 0.001);
}

TEST(JeansDraft, BadMeasuresAreRefused) {
  const auto complaint = [](auto change) {
    JeansMeasures measures = JeansBody{}.measures();
    change(measures);
    return sentence_of<InputError>([&] { draft_jeans(measures); });
  };
  EXPECT_THAT(complaint([](JeansMeasures& m) { m.girth = nullptr; }),
              StartsWith("jeans: the body's girth is missing"));
  EXPECT_THAT(complaint([](JeansMeasures& m) { m.girth = [](double) { return -1.0; }; }),
              AllOf(StartsWith("jeans: the body's girth at the height 0.86 m is -1 m"),
                    HasSubstr("from 0.2 to 5 m")));
  EXPECT_THAT(complaint([](JeansMeasures& m) { m.knee_height = 0.08; }),
              AllOf(StartsWith("jeans: the knee's height, knee_height_m,"),
                    EndsWith("is 0.08 m; give a length from 0.1 to 2 m")));
  EXPECT_THAT(complaint([](JeansMeasures& m) { m.waist_height = 0.86; }),
              StartsWith("jeans: the waist's height"));
  EXPECT_THAT(complaint([](JeansMeasures& m) { m.crotch_height = 0.5; }),
              StartsWith("jeans: the crotch line's height"));
  EXPECT_THAT(complaint([](JeansMeasures& m) { m.thigh_ease = 0.6; }),
              StartsWith("jeans: the ease at the thigh, thigh_ease_m, is 0.6 m"));
  EXPECT_THAT(complaint([](JeansMeasures& m) {
                m.thigh_ease = 0;
                m.crotch_ease = -0.05;
                m.knee_height = m.crotch_height - 0.01;
              }),
              StartsWith("jeans: the thigh's height, 1 cm below"));
  EXPECT_THAT(complaint([](JeansMeasures& m) { m.hem = std::nan(""); }),
              StartsWith("jeans: the jeans' circumference at the hem, hem_m, is nan"));
}

TEST(JeansGrid, TheNumberOfNodesIsMetWithCellsAboutSquare) {
  for (const double hip : hips) {
    const JeansDraft draft = draft_jeans(JeansBody{hip}.measures());
    for (const std::uint32_t nodes : node_counts) {
      const JeansGrid grid = jeans_grid(draft, nodes);
      EXPECT_NEAR(2 * grid.rows * (grid.front_columns + grid.back_columns), nodes, 0.03 * nodes);
      const double height = draft.front.outer.length() / (grid.rows - 1);
      const double knee = 0.5 * (0.42 / 2 - 0.01 + draft.front.waist.length()) / (grid.front_columns - 1);
      EXPECT_NEAR(height / knee, 1, 0.3) << hip << " " << nodes;
      EXPECT_GT(grid.back_columns, grid.front_columns);
    }
  }
  EXPECT_THAT(sentence_of<InputError>([] { jeans_grid(draft_jeans(JeansBody{}.measures()), 299); }),
              HasSubstr("cannot have 299 nodes; give a number from 300"));
}

TEST(Jeans, CellsFoldForNoHipAndNoNumberOfNodes) {
  for (const double hip : hips)
    for (const std::uint32_t nodes : node_counts) {
      const System build = build_for(JeansBody{hip}, nodes);  // throws where a cell folds
      EXPECT_NEAR(static_cast<double>(garment_in(build).flat.size()), nodes, 0.03 * nodes);
    }
}

TEST(Jeans, PanelsAndSeamsAreNamedByTheWearersSides) {
  const System build = build_for(JeansBody{}, 1'000);
  std::vector<std::string> names;
  for (const GarmentPanel& panel : garment_in(build).panels) {
    names.push_back(panel.name);
    Vec3d sum{};
    for (std::uint32_t i = 0; i < panel.nodes(); ++i) sum += build.start.position[panel.first_node + i];
    EXPECT_EQ(sum.x > 0, panel.name.ends_with("left")) << panel.name;
    EXPECT_EQ(sum.z > 0, panel.name.starts_with("front")) << panel.name;
  }
  EXPECT_THAT(names, ElementsAre("front left", "back left", "front right", "back right"));
  EXPECT_THAT(garment_in(build).seams, ElementsAre("outer left", "outer right", "inner left", "inner right",
                                                   "centre front", "centre back"));
}

TEST(Jeans, EverythingBelongsToTheSameNodes) {
  const System build = build_for(JeansBody{}, 4'000, {.waistband = {.height = 0.035}});
  std::size_t nodes = 0, springs = 0;
  for (const GarmentPanel& panel : garment_in(build).panels) {
    EXPECT_EQ(panel.first_node, nodes);
    nodes += panel.nodes();
    springs += count_springs(panel.rows, panel.columns);
  }
  EXPECT_EQ(garment_in(build).flat.size(), nodes);
  EXPECT_EQ(build.start.position.size(), nodes);
  EXPECT_EQ(build.node_mass.size(), nodes);
  EXPECT_EQ(build.springs.size(), springs);
  EXPECT_EQ(build.materials.size(), 4U * 4);
  for (const Spring& spring : build.springs) {
    ASSERT_LT(spring.second, nodes);
    ASSERT_LT(spring.kind, build.materials.size());
    EXPECT_NEAR(spring.rest_length,
                length(garment_in(build).flat[spring.first] - garment_in(build).flat[spring.second]), 1e-7);
  }
  for (const double mass : build.node_mass) EXPECT_GT(mass, 0);
}

TEST(Jeans, LeftAndRightAreMirrorImages) {
  const System build = build_for(JeansBody{}, 1'000);
  for (const std::size_t p : {0U, 1U}) {
    const GarmentPanel &left = garment_in(build).panels[p], &right = garment_in(build).panels[p + 2];
    for (std::uint32_t row = 0; row < left.rows; ++row)
      for (std::uint32_t column = 0; column < left.columns; ++column) {
        const Vec3d& a = build.start.position[left.node(row, column)];
        const Vec3d& b = build.start.position[right.node(row, right.columns - 1 - column)];
        EXPECT_LT(length(a - Vec3d{-b.x, b.y, b.z}), 5e-6);
      }
  }
}

TEST(Jeans, SeamsJoinNodeToNodeAndMeetInTheCrotchPoint) {
  const System build = build_for(JeansBody{}, 4'000);
  const JeansDraft draft = draft_jeans(JeansBody{}.measures());
  const std::array<double, 6> wanted{draft.front.outer.length(),  draft.front.outer.length(),
                                     draft.front.inseam.length(), draft.front.inseam.length(),
                                     draft.front.centre.length(), draft.back.centre.length()};
  std::array<double, 6> lengths{};
  for (const Joint& joint : garment_in(build).joints) {
    EXPECT_EQ(joint.edge_first, joint.edge_second);
    lengths.at(joint.seam) += joint.length;
    // They start at about the same height.
    EXPECT_NEAR(build.start.position[joint.node].y, build.start.position[joint.edge_first].y, 0.03);
  }
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(lengths.at(i), wanted.at(i), 1e-9) << i;
  // The inner seam's last joint is a centre seam's first one on both sides.
  const auto ends = [&](std::uint32_t seam, bool last) {
    std::vector<Joint> joints;
    for (const Joint& joint : garment_in(build).joints)
      if (joint.seam == seam) joints.push_back(joint);
    return last ? joints.back() : joints.front();
  };
  EXPECT_EQ(ends(2, true).node, ends(4, false).node);
  EXPECT_EQ(ends(2, true).edge_first, ends(5, false).node);
  EXPECT_EQ(ends(3, true).node, ends(4, false).edge_first);
  EXPECT_EQ(ends(3, true).edge_first, ends(5, false).edge_first);
}

TEST(Jeans, LieCloseBesideTheOuterSeamsFromThighToHip) {
  const Garment garment = garment_in(build_for(JeansBody{}, 4'000));
  EXPECT_DOUBLE_EQ(garment.close.lowest, JeansBody::crotch - 0.01);
  EXPECT_DOUBLE_EQ(garment.close.highest, 0.86);
  EXPECT_TRUE(std::ranges::is_sorted(garment.close.nodes));
  for (const GarmentPanel& panel : garment.panels) {
    // Seen from outside, the outer seam is at the right of the left front and of the right back.
    const bool at_right = panel.name == "front left" || panel.name == "back right";
    for (std::uint32_t row = 0; row < panel.rows; ++row)
      for (std::uint32_t column = 0; column < panel.columns; ++column) {
        const std::uint32_t node = panel.node(row, column);
        const Vec3d& seam = garment.flat[panel.node(row, at_right ? panel.columns - 1 : 0)];
        EXPECT_EQ(std::ranges::binary_search(garment.close.nodes, node),
                  length(garment.flat[node] - seam) <= 0.05)
            << panel.name << ", row " << row << ", column " << column;
      }
  }
}

TEST(Jeans, LieCloseAsFarUpAsTheBodyIsWidestWhateverTheirOwnHip) {
  const auto highest = [](double hip_height) {
    JeansMeasures measures = JeansBody{}.measures();
    measures.hip_height = hip_height;
    measures.body_hip_height = 0.87;
    return jeans_pattern(measures, 1'000, {}, JeansBody{}.leg_axis()).close.highest;
  };
  EXPECT_EQ(highest(0.84), 0.87);
  EXPECT_EQ(highest(0.88), 0.88);
}

TEST(Jeans, HaveACrotchOfFourNodesWhateverElseIsSewn) {
  const JeansBody body;
  GarmentPattern pattern = body.pattern(1'000);
  const Garment alone = garment_in(build_garment(pattern, body.depths()));
  ASSERT_EQ(alone.crotch.size(), 4U);
  for (const std::uint32_t node : alone.crotch)
    EXPECT_NEAR(alone.flat[node].y, JeansBody::crotch - body.measures().crotch_ease, 0.05);
  // A seam of the user's, with the name of one of theirs, that meets a side seam.
  pattern.panels.push_back(pattern.panels[0]);
  pattern.panels.back().piece.name = "patch";
  pattern.seams.push_back(
      {"outer left", {"front left", PanelEdge::bottom, 0, 1}, {"patch", PanelEdge::bottom, 0, 1}});
  const Garment patched = garment_in(build_garment(pattern, body.depths()));
  EXPECT_EQ(patched.crotch, alone.crotch);
  EXPECT_EQ(patched.close.nodes, alone.close.nodes);
}

TEST(Jeans, TheWaistbandsJointsPullHarder) {
  const System build = build_for(JeansBody{}, 4'000, {.waistband = {.height = 0.035}});
  const GarmentPanel& panel = garment_in(build).panels[0];
  std::size_t strong = 0;
  for (const Joint& joint : garment_in(build).joints) {
    if (joint.strength == 1) continue;
    EXPECT_EQ(joint.strength, 4);
    EXPECT_GE((joint.node % panel.nodes()) / panel.columns + 4, joint.node < panel.nodes() ? panel.rows : 0);
    ++strong;
  }
  EXPECT_EQ(strong % 4, 0U);
  EXPECT_GE(strong, 8U);
}

TEST(Jeans, AllNodesStartOutsideTheBody) {
  for (const double hip : hips) {
    const JeansBody body{hip};
    for (const Vec3d& node : build_for(body, 4'000).start.position)
      EXPECT_FALSE(body.holds(node)) << hip << ": " << node.x << " " << node.y << " " << node.z;
  }
}

TEST(GarmentBuild, TwoPanelsOfOneNameAreRefused) {
  const JeansBody body;
  GarmentPattern pattern = body.pattern(1'000);
  pattern.panels[2].piece.name = "front left";
  EXPECT_EQ(sentence_of<InputError>([&] { build_garment(pattern, body.depths()); }),
            "front left: two panels have this name; rename one of them");
}

TEST(GarmentBuild, BadClothIsNamedByItsPanel) {
  const JeansBody body;
  GarmentPattern pattern = body.pattern(1'000);
  pattern.panels[1].cloth.area_density = -1;
  EXPECT_THAT(sentence_of<InputError>([&] { build_garment(pattern, body.depths()); }),
              StartsWith("back left: the cloth's area"));
}

}  // namespace
}  // namespace mssim
