// Garments of pieces that a scene file draws.

#include "garment/contact/body_maps.h"
#include "garment/layers/cloth_contacts.h"
#include "scene/fields/fields.h"
#include "scene/scene_file.h"
#include "scene/scene_kinds.h"
#include "tests/support/files_fixture.h"
#include "tests/support/garment_system.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

/// Two rectangles of 6 x 5 nodes, 0.4 m wide and 0.25 m high, before and behind the hips of the reference
/// body, sewn along their sides. The back one is an outer layer of a cloth of its own.
const std::string two_pieces = R"({
  "kind": "garment", "description": "Two pieces", "dt_s": 1e-4, "gravity_m_per_s2": 9.81,
  "viscous_damping_per_s": 16, "floor": {"height_m": 0, "restitution": 0, "friction": 0.5},
  "garment": {
    "body": "mannequin",
    "mannequin": {
      "bust": {"girth_m": 0.9, "height_m": 1.28}, "waist": {"girth_m": 0.74, "height_m": 1.04},
      "hip": {"girth_m": 0.98, "height_m": 0.86}, "thigh": {"girth_m": 0.56, "height_m": 0.76},
      "knee": {"girth_m": 0.37, "height_m": 0.46}, "ankle": {"girth_m": 0.24, "height_m": 0.09},
      "crotch_height_m": 0.768, "hip_depth_over_width": 0.72, "thigh_gap_m": 0.01, "stance_m": 0.25,
      "cells_around": 16
    },
    "pixel_m": 0.01, "skin_m": 0.003,
    "pattern": "pieces",
    "pieces": {
      "panels": [
        {
          "name": "apron", "rows": 6, "columns": 5, "layer": 0,
          "bottom": {"curve": "polyline", "points_m": [[-0.2, 0.8], [0.2, 0.8]]},
          "top": {"curve": "polyline", "points_m": [[-0.2, 1.05], [0.2, 1.05]]},
          "left": {"curve": "polyline", "points_m": [[-0.2, 0.8], [-0.2, 1.05]]},
          "right": {"curve": "bezier",
                    "points_m": [[0.2, 0.8], [0.2, 0.85], [0.2, 1], [0.2, 1.05]]},
          "placement": {"side": "front", "axis_m": 0.1, "distance_m": 0.05, "bend_radius_m": 0.2}
        },
        {
          "name": "seat", "rows": 6, "columns": 5, "layer": 1,
          "bottom": {"curve": "polyline", "points_m": [[-0.2, 0.8], [0.0, 0.8], [0.2, 0.8]]},
          "top": {"curve": "polyline", "points_m": [[-0.2, 1.05], [0.0, 1.05], [0.2, 1.05]]},
          "left": {"curve": "polyline", "points_m": [[-0.2, 0.8], [-0.2, 0.9], [-0.2, 1.05]]},
          "right": {"curve": "polyline", "points_m": [[0.2, 0.8], [0.2, 0.9], [0.2, 1.05]]},
          "placement": {"side": "back", "axis_m": 0.1, "distance_m": 0.08, "bend_radius_m": 0.2},
          "cloth": {"areal_density_kg_per_m2": 0.1, "structural_n_per_m": 50, "shear_n_per_m": 20,
                    "bending_n_per_m": 1, "least_mass_share": 0}
        }
      ],
      "seams": [
        {"name": "side left", "tolerance": 0.03,
         "first": {"panel": "apron", "edge": "right", "from": 0, "to": 1},
         "second": {"panel": "seat", "edge": "left", "from": 0, "to": 1}},
        {"name": "side right", "tolerance": 0.02,
         "first": {"panel": "apron", "edge": "left", "from": 0, "to": 0.6},
         "second": {"panel": "seat", "edge": "right", "from": 0, "to": 0.6}}
      ]
    },
    "cloth": {"areal_density_kg_per_m2": 0.4, "structural_n_per_m": 200, "shear_n_per_m": 60,
              "bending_n_per_m": 8, "least_mass_share": 0},
    "dressing": {
      "seam_force_n_per_m": 4, "seam_force_doubling_s": 0.5, "seaming_damping_per_s": 8, "seaming_gravity": 0,
      "longest_seaming_s": 1, "sewn_gap_m": 0.01, "closing_share": 0.2, "closing_speed_m_per_s": 0.5,
      "friction": 0.5, "push_speed_m_per_s": 1, "correction": "none", "none": {}
    }
  }
})";

/// The end of two_pieces, and with layers that collide.
const char* const dressing_end = R"("none": {}
    })";
const char* const with_layers = R"("none": {}
    },
    "layers": {"thickness_m": 0.004, "friction": 0.2, "push_speed_m_per_s": 0.7, "sweeps": 3})";

System built(const std::string& text) { return build_system(parse_scene("pieces.json", text)); }

double mass_of(const System& system, const GarmentPanel& panel) {
  const auto first = system.node_mass.begin() + panel.first_node;
  return std::accumulate(first, first + panel.nodes(), 0.0);
}

TEST(GarmentPieces, BecomePanelsOfTheirOwnClothBeforeAndBehindTheBody) {
  const System system = built(two_pieces);
  const Garment& garment = garment_in(system);
  ASSERT_EQ(garment.panels.size(), 2U);
  const GarmentPanel &apron = garment.panels[0], &seat = garment.panels[1];
  EXPECT_EQ(apron.name, "apron");
  EXPECT_EQ(seat.name, "seat");
  EXPECT_EQ(apron.layer, 0U);
  EXPECT_EQ(seat.layer, 1U);
  EXPECT_EQ(system.nodes(), 60U);
  // Of each 6 x 5 grid 49 structural springs, 40 shear ones, and 38 for bending.
  EXPECT_EQ(system.springs.size(), 2 * 127U);
  EXPECT_EQ(counts_of(parse_scene("pieces.json", two_pieces)).springs_unique, 254U);
  EXPECT_NEAR(mass_of(system, apron), 0.4 * 0.4 * 0.25, 1e-6);
  EXPECT_NEAR(mass_of(system, seat), 0.1 * 0.4 * 0.25, 1e-6);
  for (const Spring& spring : system.springs) {
    const double stiffness = system.materials[spring.kind].stiffness;
    if (spring.second == spring.first + 1) {
      EXPECT_EQ(stiffness, spring.first < seat.first_node ? 200 : 50);
    }
  }
  for (std::uint32_t node = 0; node < 60; ++node) {
    const bool before = node < seat.first_node;
    const Vec3d &start = system.start.position[node], &flat = garment.flat[node];
    EXPECT_NEAR(start.y, flat.y, 1e-6);
    EXPECT_EQ(flat.z, 0);
    EXPECT_GT(before ? start.z : -start.z, 0);
    // On the axis nothing is bent; seen from behind, left is right.
    EXPECT_NEAR(flat.x == 0 ? start.x : 0.1, 0.1, 1e-6);
    EXPECT_TRUE(flat.x == 0 || (flat.x > 0) == (before == (start.x > 0.1))) << "node " << node;
  }
}

TEST(GarmentPieces, AreSewnWhereTheSeamsSay) {
  const Garment garment = garment_in(built(two_pieces));
  EXPECT_THAT(garment.seams, ElementsAre("side left", "side right"));
  const GarmentPanel &apron = garment.panels[0], &seat = garment.panels[1];
  // All six rows of one side; 0.6 of five cells are the lowest four of the other.
  ASSERT_EQ(garment.joints.size(), 6U + 4U);
  for (std::uint32_t row = 0; row < 6; ++row) {
    EXPECT_EQ(garment.joints[row].node, apron.node(row, 4));
    EXPECT_EQ(garment.joints[row].edge_first, seat.node(row, 0));
    EXPECT_EQ(garment.joints[row].seam, 0U);
  }
  for (std::uint32_t row = 0; row < 4; ++row) {
    EXPECT_EQ(garment.joints[6 + row].node, apron.node(row, 0));
    EXPECT_EQ(garment.joints[6 + row].edge_first, seat.node(row, 4));
  }
}

TEST(GarmentPieces, TouchOnlyWhereLayersAreAskedFor) {
  std::string unsewn = two_pieces;
  const std::size_t seams = unsewn.find(",\n      \"seams\"");
  unsewn.erase(seams, unsewn.find(']', seams) + 1 - seams);
  const Garment garment = garment_in(built(with_change(unsewn, dressing_end, with_layers)));
  ASSERT_TRUE(garment.touching);
  EXPECT_EQ(garment.touching->thickness, 0.004);
  EXPECT_EQ(garment.touching->friction, 0.2);
  EXPECT_EQ(garment.touching->push_speed, 0.7);
  EXPECT_EQ(garment.touching->sweeps, 3U);
  EXPECT_THAT(layer_pairs(garment), ElementsAre(PanelPair{0, 1}));
  // In front of the belly the outer layer meets the body 4 mm before the inner one.
  ASSERT_EQ(garment.body_maps.size(), 2U);
  const auto distance = [&](std::size_t layer) {
    return garment.body_maps[layer]->contact(0.0, 0.9, 0.2).distance;
  };
  EXPECT_NEAR(distance(0) - distance(1), 0.004, 6e-4);  // the pixels are large

  const Garment one_layer = garment_in(built(
      with_change(with_change(two_pieces, dressing_end, with_layers), R"("layer": 1)", R"("layer": 0)")));
  EXPECT_FALSE(one_layer.touching) << "there is nothing to collide";
  const Garment loose = garment_in(built(two_pieces));
  EXPECT_FALSE(loose.touching);
  EXPECT_EQ(loose.body_maps.size(), 1U);
}

TEST(GarmentPieces, GoWithJeans) {
  std::string text = with_change(two_pieces, R"("pattern": "pieces",
    "pieces": {)",
                                 R"("pattern": "outfit",
    "outfit": {
      "jeans": {"nodes": 400, "waist_height_m": 1.005, "hip_height_m": 0.86, "knee_height_m": 0.47,
                "hem_height_m": 0.07, "knee_m": 0.42, "hem_m": 0.36, "hip_ease_m": 0, "waist_ease_m": 0.01,
                "crotch_ease_m": 0.03},)");
  const Garment garment = garment_in(built(text));
  ASSERT_EQ(garment.panels.size(), 6U);
  EXPECT_EQ(garment.panels[0].name, "front left");
  EXPECT_EQ(garment.panels[5].name, "seat");
  ASSERT_EQ(garment.seams.size(), 8U);
  EXPECT_EQ(garment.seams[6], "side left");
  // The seat is over the jeans, and over the apron, which is of their layer.
  EXPECT_THAT(layer_pairs(garment), ElementsAre(PanelPair{0, 5}, PanelPair{1, 5}, PanelPair{2, 5},
                                                PanelPair{3, 5}, PanelPair{4, 5}));

  // What does not fit is told from what does not fit of the jeans.
  const auto error_of = [](const std::string& scene) {
    return sentence_of<SceneError>([&] { built(scene); });
  };
  EXPECT_THAT(error_of(with_change(text, "\"name\": \"apron\"", "\"name\": \"back left\"")),
              HasSubstr("/garment/outfit/panels/0 does not fit: back left: two panels have this name"));
  EXPECT_THAT(error_of(with_change(text, "\"tolerance\": 0.02,\n         \"first\": {\"panel\": \"apron\"",
                                   "\"tolerance\": 0.02,\n         \"first\": {\"panel\": \"front right\"")),
              HasSubstr("/garment/outfit/seams/1 does not fit: seam side right: "));
  EXPECT_THAT(error_of(with_change(text, dressing_end, with_layers)),
              HasSubstr("/garment/outfit/seams/0 sews apron in layer 0 to seat in layer 1"));
  EXPECT_THAT(error_of(with_change(text, "\"hip_height_m\": 0.86", "\"hip_height_m\": 1.5")),
              HasSubstr("/garment/outfit/jeans does not fit: jeans: the waist's height"));
}

/// A change to two_pieces, and what its error names: place, value, remedy.
struct BadPieces {
  const char *old_part, *new_part;
  const char *place, *value, *remedy;
};

const char* const apron_top = R"("top": {"curve": "polyline", "points_m": [[-0.2, 1.05], [0.2, 1.05]]})";
const char* const first_stretch = R"("first": {"panel": "apron", "edge": "right", "from": 0, "to": 1})";

const BadPieces bad_pieces[]{
    // What the reader sees.
    {R"("name": "apron")", R"("name": "")", "/garment/pieces/panels/0/name", "is empty",
     "give the panel a name"},
    {R"("rows": 6, "columns": 5, "layer": 0)", R"("rows": 1, "columns": 5, "layer": 0)",
     "/garment/pieces/panels/0/rows", "is 1", "give an integer from 2 to 10000"},
    {R"("layer": 1)", R"("layer": 8)", "/garment/pieces/panels/1/layer", "is 8",
     "give an integer from 0 to 7"},
    {R"("rows": 6, "columns": 5, "layer": 1)", R"("rows": 10000, "columns": 1001, "layer": 1)",
     "/garment/pieces/panels", "have 10010030 nodes in all", "at most 10000000"},
    {apron_top, R"("top": {"curve": "spline", "points_m": [[-0.2, 1.05], [0.2, 1.05]]})",
     "/garment/pieces/panels/0/top/curve", "is the text \"spline\"", "give the text polyline or bezier"},
    {apron_top, R"("top": {"curve": "polyline", "points_m": [[-0.2, 1.05]]})",
     "/garment/pieces/panels/0/top/points_m",
     "has 1 element:", "give a list, [ ... ], of 2 to 100 points [x, y]"},
    {apron_top, R"("top": {"curve": "polyline", "points_m": [[-0.2, 1.05], [0.2, 1.05, 0]]})",
     "/garment/pieces/panels/0/top/points_m/1", "is a list", "give a point, two numbers [x, y]"},
    {apron_top, R"("top": {"curve": "polyline", "points_m": [[-0.2, 1.05], [0.2, 11]]})",
     "/garment/pieces/panels/0/top/points_m/1/1", "is 11", "give a number from -10 to 10"},
    {apron_top, R"("top": {"curve": "bezier", "points_m": [[-0.2, 1.05], [0, 1.1], [0.2, 1.05]]})",
     "/garment/pieces/panels/0/top", "a chain of cubic Bezier segments has 3 points", "give 4, 7, 10"},
    {R"("side": "back")", R"("side": "behind")", "/garment/pieces/panels/1/placement/side",
     "is the text \"behind\"", "give the text front or back"},
    {R"("distance_m": 0.08)", R"("distance_m": 0)", "/garment/pieces/panels/1/placement/distance_m", "is 0",
     "above 0"},
    {first_stretch, R"("first": {"panel": "apron", "edge": "rihgt", "from": 0, "to": 1})",
     "/garment/pieces/seams/0/first/edge", "is the text \"rihgt\"", "perhaps right"},
    {first_stretch, R"("first": {"panel": "apron", "edge": "right", "from": 0, "to": 1.1})",
     "/garment/pieces/seams/0/first/to", "is 1.1", "from 0 to 1"},
    {dressing_end,
     R"("none": {}},
    "layers": {"thickness_m": 0, "friction": 0.2, "push_speed_m_per_s": 0.7, "sweeps": 3})",
     "/garment/layers/thickness_m", "is 0", "from 1e-06 to 10"},
    // What cutting, sewing and placing see.
    {R"("name": "seat")", R"("name": "apron")", "/garment/pieces/panels/1", "two panels have this name",
     "rename one of them"},
    {apron_top, R"("top": {"curve": "polyline", "points_m": [[-0.2, 1.05], [0.21, 1.05]]})",
     "/garment/pieces/panels/0", "apron: at the top right corner", "make them meet"},
    {first_stretch, R"("first": {"panel": "aprn", "edge": "right", "from": 0, "to": 1})",
     "/garment/pieces/seams/0", "there is no panel aprn", "use one of apron, seat"},
    {first_stretch, R"("first": {"panel": "apron", "edge": "right", "from": 0.4, "to": 1})",
     "/garment/pieces/seams/0", "is 0.15 m long", "raise the seam's tolerance of 0.03"},
    {dressing_end, with_layers, "/garment/pieces/seams/0", "apron in layer 0 to seat in layer 1",
     "leave out \"layers\""}};

TEST(GarmentPieces, ThatAreBrokenAreRefusedInOneSentenceWithPlaceValueAndRemedy) {
  for (const BadPieces& bad : bad_pieces)
    EXPECT_THAT(sentence_of<SceneError>([&] { built(with_change(two_pieces, bad.old_part, bad.new_part)); }),
                AllOf(StartsWith(std::string("pieces.json: ") + bad.place + " "), HasSubstr(bad.value),
                      HasSubstr(bad.remedy), Not(HasSubstr("\n"))))
        << bad.new_part;
}

TEST(GarmentPieces, NeedABodyAtTheirHeights) {
  std::string text = two_pieces;
  // The seat begins under the floor, where there is no body.
  for (std::size_t at = text.rfind("0.8]"); at != std::string::npos && at > text.find("\"seat\"");
       at = text.rfind("0.8]", at - 1))
    text.replace(at, 4, "-0.8]");
  EXPECT_THAT(sentence_of<SceneError>([&] { built(text); }),
              AllOf(HasSubstr("/garment/pieces/panels/1 does not fit: "),
                    HasSubstr("there is no section at the height -0.8 m")));
}

TEST(GarmentPieces, AreNotPutOnUnderTheFloor) {
  std::string text = two_pieces;
  constexpr std::string_view floor = R"("floor": {"height_m": 0,)";
  text.replace(text.find(floor), floor.size(), R"("floor": {"height_m": 0.9,)");
  EXPECT_THAT(sentence_of<SceneError>([&] { built(text); }),
              AllOf(HasSubstr("/floor/height_m is 0.9, but the garment would start down to 0.8"),
                    HasSubstr("lower the floor")));
}

}  // namespace
}  // namespace mssim
