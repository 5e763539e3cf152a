#include "garment/scene/garment_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "garment/contact/body_maps.h"
#include "garment/layers/cloth_contacts.h"
#include "garment/scene/garment_body.h"
#include "garment/scene/garment_cut.h"
#include "scene/fields/fields.h"
#include "scene/spec/scene_spec.h"
#include "text/text.h"

namespace mssim {
namespace {

constexpr std::uint32_t fewest_nodes = 300, most_nodes = 10'000'000;

void visit_jeans(FieldVisitor& fields, JeansSpec& jeans) {
  fields.integer({"nodes", "About how many nodes all panels have."}, jeans.nodes, fewest_nodes, most_nodes);
  visit_length(fields, {"waist_height_m", "Height at which the upper edge is worn at the side, m."},
               jeans.measures.waist_height);
  visit_length(fields, {"hip_height_m", "Height at which the body's girth is largest, m."},
               jeans.measures.hip_height);
  visit_length(fields, {"knee_height_m", "Height of the knee, m."}, jeans.measures.knee_height);
  visit_length(fields, {"hem_height_m", "Height at which the hem is worn, m."}, jeans.measures.hem_height);
  visit_length(fields, {"knee_m", "Around one leg of the jeans at the knee, m."}, jeans.measures.knee);
  visit_length(fields, {"hem_m", "Around one leg of the jeans at the hem, m."}, jeans.measures.hem);
  fields.number(
      {"hip_ease_m",
       "How much wider than 0.969 of the body, and what lies between, the jeans are at the hip, all "
       "round, m."},
      jeans.measures.hip_ease, from(0, largest_length_m));
  fields.number({"waist_ease_m", "The same at the waist, over 0.994 of the body, m."},
                jeans.measures.waist_ease, from(-0.2, largest_length_m));
  fields.number({"crotch_ease_m", "How far the crotch of the jeans lies below the body's, m."},
                jeans.measures.crotch_ease, from(0, largest_length_m));
}

void visit_correction(FieldVisitor& fields, DressingSettings& dressing, VelocityCorrection correction) {
  dressing.correction = correction;
  if (correction == VelocityCorrection::none) return;
  fields.number(
      {"threshold", "Elongation over rest length beyond which a spring is corrected, without unit."},
      dressing.correction_threshold, from(0, 10));
  fields.integer({"sweeps", "Passes over all springs in a step, forwards and backwards by turns."},
                 dressing.correction_sweeps, 1, 1000);
  if (correction == VelocityCorrection::bounded)
    fields.number({"rate", "Share of the excess that a step takes away, without unit."},
                  dressing.correction_rate, from(0, 1));
}

void visit_dressing(FieldVisitor& fields, DressingSettings& dressing) {
  fields.number({"seam_force_n_per_m", "Force that draws a seam together at first, per length, N/m."},
                dressing.seam_force, from(0, 1e6));
  fields.number({"seam_force_doubling_s", "Time in which that force has grown by its first value, s."},
                dressing.seam_force_doubling_s, above(0, 1e6));
  fields.number({"seaming_damping_per_s",
                 "Deceleration of every node per speed while the seams close, 1/s; viscous_damping_per_s is "
                 "for draping."},
                dressing.seaming_damping, from(0, 1e6));
  fields.number({"seaming_gravity", "Share of gravity that acts while the seams close, without unit."},
                dressing.seaming_gravity, from(0, 1));
  fields.number({"longest_seaming_s", "Simulated time after which open seams are sewn as they are, s."},
                dressing.longest_seaming_s, from(0, 1e6));
  visit_length(fields, {"sewn_gap_m", "Gap below which a joint counts as sewn and its ends move as one, m."},
               dressing.sewn_gap);
  fields.number({"closing_share", "Share of a sewn joint's gap that a step closes at most, without unit."},
                dressing.closing_share, from(0, 1));
  fields.number({"closing_speed_m_per_s", "Speed at which a sewn joint's gap closes at most, m/s."},
                dressing.closing_speed, above(0, 1000));
  fields.number({"friction", "Coulomb's coefficient between cloth and body while draping, without unit."},
                dressing.friction, from(0, 100));
  fields.number({"push_speed_m_per_s", "Speed at which a point inside the body is moved out at most, m/s."},
                dressing.push_speed, from(0, 1000));
  const auto section = [&](const Field& field, VelocityCorrection correction) {
    return Section{
        field, [&dressing, correction](FieldVisitor& rule) { visit_correction(rule, dressing, correction); }};
  };
  const std::array sections{
      section({"none", "Nothing is done to over-elongated springs."}, VelocityCorrection::none),
      section(
          {"published", "What lengthens an over-elongated spring is taken from the velocities of its ends."},
          VelocityCorrection::published),
      section(
          {"bounded",
           "An over-elongated spring has to shorten: its ends part at -rate times excess per step at most."},
          VelocityCorrection::bounded)};
  fields.one_of({"correction", "Which of the sections says what is done to over-elongated springs."},
                sections);
}

void visit_layers(FieldVisitor& fields, ClothClothSettings& layers) {
  visit_length(fields,
               {"thickness_m", "Distance that layers keep, m; more than what they approach in a step."},
               layers.thickness);
  fields.number({"friction", "Coulomb's coefficient of friction between layers."}, layers.friction,
                from(0, 100));
  fields.number({"push_speed_m_per_s",
                 "Speed at which layers that are too near or have crossed are moved apart at most, m/s."},
                layers.push_speed, from(0, 1000));
  fields.integer({"sweeps", "Sweeps over all contacts in a step."}, layers.sweeps, 1, 1000);
}

/// The body as each layer meets it: where layers touch, an outer one has no room but for what lies under it.
std::vector<std::shared_ptr<const BodyMaps>> maps_for_layers(const SceneSpec& spec, const Garment& garment,
                                                             const Surface& body, double offset) {
  std::uint32_t outermost = 0;
  if (garment.touching)
    for (const GarmentPanel& panel : garment.panels) outermost = std::max(outermost, panel.layer);
  std::vector<std::shared_ptr<const BodyMaps>> maps;
  try {
    for (std::uint32_t layer = 0; layer <= outermost; ++layer) {
      const double beneath = layer > 0 ? layer * garment.touching->settings.thickness : 0;
      maps.push_back(std::make_shared<BodyMaps>(
          body, BodyMapSettings{.pixel = garment_of(spec).pixel_m, .offset = offset + beneath}));
    }
  } catch (const std::exception& error) {
    refuse(spec.file, "/garment/pixel_m", "gives no maps of the body: " + printable(error.what(), 1500));
  }
  return maps;
}

SceneCounts counts_of(const GarmentBuild& build) { return {build.placed.size(), build.springs.size()}; }

BuiltScene built(const SceneSpec& spec, std::shared_ptr<const MeasuredBody> body, const FittedGarment& cut) {
  const GarmentSpec& garment = garment_of(spec);
  const GarmentBuild& build = cut.build;
  require_memory(spec, "/garment", counts_of(build));
  const double lowest_start = std::ranges::min(build.placed, {}, &Vec3d::y).y;
  if (lowest_start < spec.floor.height)
    refuse(spec.file, "/floor/height_m",
           "is " + shown_number(spec.floor.height) + ", but the garment would start down to " +
               shown_number(lowest_start) + ": lower the floor or wear the garment higher");
  System system;
  system.springs = build.springs;
  system.materials = build.materials;
  system.node_mass = build.node_mass;
  system.gravity = spec.gravity_m_per_s2;
  system.viscous_damping = spec.viscous_damping_per_s;
  system.floor = spec.floor;
  system.start.position = build.placed;
  system.start.velocity.resize(system.start.position.size());

  Garment dressed = build.garment;
  dressed.dressing = garment.dressing;
  if (garment.layers) dressed.touching = {{layer_pairs(dressed), {}}, *garment.layers};
  const TrunkAndLegs& met = body->profile.trunk_and_legs();
  dressed.body_maps = maps_for_layers(spec, dressed, met.surface, cut.body_offset);
  system.topology = std::move(dressed);
  std::string note = body->note;
  append_sentence(note, ignored_parts(met));
  return {std::move(system), std::move(note), std::move(body)};
}

}  // namespace

void visit_garment_fields(FieldVisitor& fields, SceneSpec& spec) {
  GarmentSpec& garment = spec.content.emplace<GarmentSpec>();
  visit_body_fields(fields, garment);
  visit_length(fields, {"pixel_m", "Width of a pixel of the maps that cloth collides with, m."},
               garment.pixel_m);
  fields.number({"skin_m",
                 "How far the maps lie before the body's surface, m; what coarse cloth needs lest the body "
                 "shows between its nodes is added."},
                garment.skin_m, from(0, largest_length_m));
  constexpr Field jeans_field{"jeans",
                              "Jeans of four panels and six seams that fit the body; its girths and the "
                              "height of its crotch are measured."};
  const auto jeans_of = [&](FieldVisitor& jeans) { visit_jeans(jeans, garment.jeans.emplace()); };
  const auto pieces_of = [&](FieldVisitor& pieces) { visit_pieces(pieces, garment.pieces.emplace()); };
  const std::array patterns{
      Section{jeans_field, jeans_of},
      Section{{"pieces", "Panels and seams of one's own pattern."}, pieces_of},
      Section{{"outfit", "Jeans, and panels and seams of one's own pattern."}, [&](FieldVisitor& outfit) {
                outfit.object(jeans_field, Presence::required, jeans_of);
                pieces_of(outfit);
              }}};
  fields.one_of({"pattern",
                 "What is dressed, and the key of the section that describes it: jeans drafted for the body, "
                 "pieces of one's own, or both."},
                patterns);
  fields.object({"cloth", "What jeans, and pieces without a cloth of their own, are cut from."},
                Presence::required, [&](FieldVisitor& cloth) { visit_cloth(cloth, garment.cloth); });
  fields.object({"dressing", "How the panels are drawn together and draped."}, Presence::required,
                [&](FieldVisitor& dressing) { visit_dressing(dressing, garment.dressing); });
  fields.object({"layers",
                 "How layers of cloth keep apart; left out, they go through each other. The body lies "
                 "further out for each layer by the thickness."},
                Presence::optional,
                [&](FieldVisitor& layers) { visit_layers(layers, garment.layers.emplace()); });
  fields.object(
      {"expected", "What the pattern comes to, for listings."}, Presence::optional,
      [&](FieldVisitor& expected) {
        MeshSize& size = garment.expected.emplace();
        expected.integer({"nodes", "Nodes of all panels."}, size.nodes, 4, most_nodes);
        expected.integer({"springs", "Unique springs of all panels."}, size.springs, 6, 6 * most_nodes);
      });
}

void check_garment(const SceneSpec& spec) {
  check_body(spec);
  const GarmentSpec& garment = garment_of(spec);
  if (garment.pieces) check_pieces(spec.file, pieces_pointer(garment), *garment.pieces, most_nodes);
}

std::optional<SceneCounts> stated_garment_counts(const SceneSpec& spec) {
  const std::optional<MeshSize>& expected = garment_of(spec).expected;
  return expected ? std::optional(SceneCounts{expected->nodes, expected->springs}) : std::nullopt;
}

SceneParts read_garment(const SceneSpec& spec) {
  const auto body = std::make_shared<const MeasuredBody>(measured_body(spec));
  const auto cut = std::make_shared<const FittedGarment>(cut_and_placed(spec, body->profile));
  return {counts_of(cut->build), stated_garment_counts(spec),
          [body, cut](const SceneSpec& of) { return built(of, body, *cut); }};
}

}  // namespace mssim
