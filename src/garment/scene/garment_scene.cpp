#include "garment/scene/garment_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <numeric>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "garment/contact/body_maps.h"
#include "garment/pattern/jeans.h"
#include "garment/scene/garment_fields.h"
#include "geometry/geometry.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

/// Radius of curvature down to which cloth, around a limb for example, must not let the body through the
/// faces between its nodes: their sagitta is h^2 / 8 r.
constexpr double least_curvature_radius_m = 0.04;

/// A trouser leg starts this far outside the leg's middle. From there, its halves close around the leg and
/// are not drawn across the other leg.
constexpr double beside_the_leg_m = 0.01;

/// The JSON pointer to a garment's jeans in its scene file.
std::string jeans_pointer(const GarmentSpec& garment) {
  return garment.pieces ? "/garment/outfit/jeans" : "/garment/jeans";
}

/// The largest over the layers of the width of a square cell of average area, m.
double widest_mean_cell(const GarmentPattern& pattern, const System& cut) {
  struct Extent {
    double area = 0, nodes = 0;
  };
  std::map<std::uint32_t, Extent> layers;
  for (std::size_t p = 0; p < pattern.panels.size(); ++p) {
    const GarmentPanel& panel = std::get<Garment>(cut.topology).panels[p];
    const auto first = cut.node_mass.begin() + panel.first_node;
    Extent& layer = layers[panel.layer];
    layer.area += std::accumulate(first, first + panel.nodes(), 0.0) / pattern.panels[p].cloth.area_density;
    layer.nodes += panel.nodes();
  }
  double widest = 0;
  for (const auto& [layer, extent] : layers) widest = std::max(widest, std::sqrt(extent.area / extent.nodes));
  return widest;
}

[[noreturn]] void refuse_measure(const SceneSpec& spec, const char* field, double value,
                                 const std::string& rest) {
  refuse(spec.file, jeans_pointer(garment_of(spec)) + '/' + field, "is " + shown_number(value) + rest);
}

/// Checks that the body reaches as far as the jeans. Throws SceneError, which names the field to change.
void require_body_there(const SceneSpec& spec, const BodyProfile& profile) {
  const JeansMeasures& jeans = garment_of(spec).jeans->measures;
  constexpr double waist_raised = 0.04;  // m, of the jeans' upper edge at the back, with a margin
  if (!profile.has_legs() && std::holds_alternative<BodyFile>(garment_of(spec).body))
    refuse(spec.file, "/garment/surface_file",
           "has no leg on each side of x = 0, which jeans need: correct \"up\", \"facing\" and \"move_m\" "
           "(mssim measure finds them)");
  if (jeans.hem_height < profile.lowest())
    refuse_measure(spec, "hem_height_m", jeans.hem_height,
                   fmt::format(", but the body starts at the height {} m: give a larger height",
                               shown(profile.lowest())));
  if (jeans.waist_height + waist_raised > profile.highest())
    refuse_measure(spec, "waist_height_m", jeans.waist_height,
                   ", but the body ends at the height " + shown(profile.highest()) +
                       " m, and the jeans' back rises 0.04 m above their waist: give a smaller height");
}

/// The message if the panels of jeans, which no user drew, cannot be cut.
std::string uncut_jeans(const JeansMeasures& jeans, const BodyProfile& profile) {
  const auto girth_at = [&](double height) {
    const double millimetres = std::round(1000 * profile.hull_girth(height));
    return fmt::format("{} m around at the height {}", shown(millimetres / 1000), shown(height));
  };
  return fmt::format(
      "cannot be cut for this body: it measures {} (hip_height_m) and {} (waist_height_m), and its legs part "
      "at {} m; give the heights of its hip and waist, and knee_height_m and hem_height_m evenly below "
      "(mssim measure finds them)",
      girth_at(jeans.hip_height), girth_at(jeans.waist_height), shown(profile.crotch_height()));
}

using OfHeight = std::function<double(double height)>;

/// Wraps a function so that it computes a value once per height. Copies share the stored values.
OfHeight remembered(OfHeight function) {
  return [function = std::move(function),
          known = std::make_shared<std::unordered_map<double, double>>()](double height) {
    const auto found = known->find(height);
    return found != known->end() ? found->second : known->emplace(height, function(height)).first->second;
  };
}

/// The measures of a body that patterns need, stored by height: mirrored panels, and a second cut with
/// another offset, ask for the same heights again.
struct AskedMeasures {
  const BodyProfile& profile;
  OfHeight girth = remembered([&of = profile](double y) { return of.hull_girth(y); });
  /// In front of the middle of the legs, above which the side seams lie.
  OfHeight front_share = remembered(
      [&of = profile](double y) { return of.front_share(y, of.leg_middle(of.crotch_height(), 1).z); });
  OfHeight leg_x = remembered([&of = profile](double y) { return of.leg_middle(y, 1).x; });
  BodyDepth depth{remembered([&of = profile](double y) { return of.front(y); }),
                  remembered([&of = profile](double y) { return of.back(y); })};
};

/// Jeans for a body enlarged on all sides by the distance of its maps.
GarmentPattern jeans_for(const GarmentSpec& garment, const AskedMeasures& body, double body_offset) {
  JeansMeasures measures = garment.jeans->measures;
  measures.body_offset = body_offset;
  measures.girth = body.girth;
  measures.front_share = body.front_share;
  measures.crotch_length = [&of = body.profile](double y) { return of.crotch_length(y); };
  measures.crotch_height = body.profile.crotch_height();
  measures.body_hip_height = find_landmarks(body.profile).hip.height;
  return jeans_pattern(measures, garment.jeans->nodes, garment.cloth,
                       [leg_x = body.leg_x](double height) { return leg_x(height) + beside_the_leg_m; });
}

/// Throws SceneError, which names a panel or seam that cannot be made.
System cut_and_placed(const SceneSpec& spec, const GarmentPattern& pattern, const AskedMeasures& body) {
  try {
    return build_garment(pattern, body.depth);
  } catch (const PatternError& error) {
    if (!error.where.empty()) refuse(spec.file, error.where, "does not fit", error);
    const GarmentSpec& garment = garment_of(spec);
    if (error.folded)
      refuse(spec.file, jeans_pointer(garment), uncut_jeans(garment.jeans->measures, body.profile));
    refuse(spec.file, jeans_pointer(garment), "does not fit", error);
  }
}

/// Throws SceneError for a seam between layers that collide: they would keep its ends apart.
void require_seams_within_layers(const SceneSpec& spec, const GarmentPattern& pattern, const Garment& cut) {
  if (!garment_of(spec).layers) return;
  for (const Joint& joint : cut.joints) {
    const GarmentPanel &one = cut.panel_of(joint.node), &other = cut.panel_of(joint.edge_first);
    if (one.layer == other.layer) continue;
    refuse(spec.file, pattern.seams[joint.seam].where,
           fmt::format("sews {} in layer {} to {} in layer {}, which collide: give both panels one layer, or "
                       "leave out \"layers\"",
                       printable(one.name), one.layer, printable(other.name), other.layer));
  }
}

FittedGarment cut_and_placed(const SceneSpec& spec, const AskedMeasures& body, double body_offset) {
  const GarmentSpec& garment = garment_of(spec);
  GarmentPattern pattern;
  if (garment.jeans) {
    require_body_there(spec, body.profile);
    pattern = refusing<InputError>(spec.file, jeans_pointer(garment), "does not fit",
                                   [&] { return jeans_for(garment, body, body_offset); });
  }
  append_pieces(garment, pattern);
  System system = cut_and_placed(spec, pattern, body);
  require_seams_within_layers(spec, pattern, std::get<Garment>(system.topology));
  const double cell = widest_mean_cell(pattern, system);
  // Distance of the maps from the body: skin, and the sagitta of a face as wide as a cell.
  return {std::move(system), garment.skin_m + cell * cell / (8 * least_curvature_radius_m)};
}

void visit_jeans(FieldVisitor& fields, JeansSpec& jeans) {
  fields.integer({"nodes", "Approximate number of nodes of all panels."}, jeans.nodes, 300,
                 most_garment_nodes);
  visit_length(fields, {"waist_height_m", "Height at which the upper edge is worn at the side, m."},
               jeans.measures.waist_height);
  visit_length(fields, {"hip_height_m", "Height at which the body's girth is largest, m."},
               jeans.measures.hip_height);
  visit_length(fields, {"knee_height_m", "Height of the knee, m."}, jeans.measures.knee_height);
  visit_length(fields, {"hem_height_m", "Height at which the hem is worn, m."}, jeans.measures.hem_height);
  visit_length(fields, {"knee_m", "Circumference of a trouser leg at the knee, m."}, jeans.measures.knee);
  visit_length(fields, {"hem_m", "Circumference of a trouser leg at the hem, m."}, jeans.measures.hem);
  fields.number({"hip_ease_m",
                 "Ease at the hip: circumference of the jeans less 0.969 of the body's girth and less what "
                 "the distance of the maps adds, m."},
                jeans.measures.hip_ease, from(0, largest_length_m));
  fields.optional_number({"thigh_ease_m",
                          "Ease at the thigh, 1 cm below the crotch, over 0.969 of the girth of both legs "
                          "together, m. Without this field, the side seams run from hip to knee without "
                          "regard to the thigh."},
                         jeans.measures.thigh_ease, from(-0.2, 0.5));
  fields.number({"waist_ease_m", "Ease at the waist, over 0.994 of the body's girth, m."},
                jeans.measures.waist_ease, from(-0.2, largest_length_m));
  fields.number({"crotch_ease_m", "Distance of the jeans' crotch below the body's, m."},
                jeans.measures.crotch_ease, from(0, largest_length_m));
}

void visit_correction(FieldVisitor& fields, DressingSettings& dressing, VelocityCorrection correction) {
  dressing.correction = correction;
  if (correction == VelocityCorrection::none) return;
  fields.number(
      {"threshold", "Elongation over rest length beyond which a spring is corrected, without unit."},
      dressing.correction_threshold, from(0, 10));
  fields.integer({"sweeps", "Passes over all springs per step, alternately forwards and backwards."},
                 dressing.correction_sweeps, 1, 1000);
  if (correction == VelocityCorrection::bounded)
    fields.number({"rate", "Fraction of the excess that a step removes, without unit."},
                  dressing.correction_rate, from(0, 1));
}

void visit_dressing(FieldVisitor& fields, DressingSettings& dressing) {
  fields.number({"seam_force_n_per_m", "Initial force per length that draws a seam together, N/m."},
                dressing.seam_force, from(0, 1e6));
  fields.number({"seam_force_doubling_s", "Time in which that force grows by its initial value, s."},
                dressing.seam_force_doubling_s, above(0, 1e6));
  fields.number({"seaming_damping_per_s",
                 "Deceleration of every node over its speed while the seams close, 1/s; draping uses "
                 "viscous_damping_per_s."},
                dressing.seaming_damping, from(0, 1e6));
  fields.number({"seaming_gravity", "Fraction of gravity that acts while the seams close, without unit."},
                dressing.seaming_gravity, from(0, 1));
  fields.number({"longest_seaming_s", "Simulated time after which open seams are sewn as they are, s."},
                dressing.longest_seaming_s, from(0, 1e6));
  constexpr std::array<std::string_view, 2> held_names{"nothing", "upper edge"};
  visit_choice(fields,
               {"held",
                "Part that keeps its height while the seams close, as if hands held it: \"nothing\" (the "
                "default), or the \"upper edge\" of every panel."},
               Presence::optional, held_names, dressing.edge_held);
  visit_length(fields, {"sewn_gap_m", "Gap below which a joint counts as sewn and its ends move as one, m."},
               dressing.sewn_gap);
  fields.number({"closing_share", "Largest fraction of a sewn joint's gap that a step closes, without unit."},
                dressing.closing_share, from(0, 1));
  fields.number({"closing_speed_m_per_s", "Largest speed at which a sewn joint's gap closes, m/s."},
                dressing.closing_speed, above(0, 1000));
  fields.number({"friction", "Coulomb's coefficient between cloth and body while draping, without unit."},
                dressing.friction, from(0, 100));
  fields.number({"push_speed_m_per_s", "Largest speed at which a point inside the body is moved out, m/s."},
                dressing.push_speed, from(0, 1000));
  const auto section = [&](const Field& field, VelocityCorrection correction) {
    return Section{
        field, [&dressing, correction](FieldVisitor& rule) { visit_correction(rule, dressing, correction); }};
  };
  const std::array sections{
      section({"none", "Over-elongated springs are not corrected."}, VelocityCorrection::none),
      section({"published",
               "The part of its ends' velocities that lengthens an over-elongated spring is removed."},
              VelocityCorrection::published),
      section({"bounded",
               "An over-elongated spring must shorten: its ends approach by at least rate times excess per "
               "step."},
              VelocityCorrection::bounded)};
  fields.one_of({"correction", "Section that describes the correction of over-elongated springs."}, sections);
}

/// The maps of the body for each layer. If layers touch, an outer one's lie further out by the thickness of
/// those beneath.
std::vector<std::shared_ptr<const BodyMaps>> maps_for_layers(const SceneSpec& spec, const Garment& garment,
                                                             const Surface& body, double offset) {
  std::uint32_t outermost = 0;
  if (garment.touching)
    for (const GarmentPanel& panel : garment.panels) outermost = std::max(outermost, panel.layer);
  std::vector<std::shared_ptr<const BodyMaps>> maps;
  for (std::uint32_t layer = 0; layer <= outermost; ++layer) {
    const double beneath = layer > 0 ? layer * garment.touching->thickness : 0;
    const BodyMapSettings settings{.pixel = garment_of(spec).pixel_m, .offset = offset + beneath};
    maps.push_back(refusing<std::exception>(spec.file, "/garment/pixel_m", "gives no maps of the body",
                                            [&] { return std::make_shared<BodyMaps>(body, settings); }));
  }
  return maps;
}

BuiltScene built(const SceneSpec& spec, std::shared_ptr<const MeasuredBody> body, const FittedGarment& cut) {
  const GarmentSpec& garment = garment_of(spec);
  System system = cut.system;
  set_laws(system, spec);
  const double lowest_start = std::ranges::min(system.start.position, {}, &Vec3d::y).y;
  if (lowest_start < spec.floor.height)
    refuse(spec.file, "/floor/height_m",
           "is " + shown_number(spec.floor.height) + ", but the garment would start down to " +
               shown_number(lowest_start) + ": lower the floor or place the garment higher");

  auto& dressed = std::get<Garment>(system.topology);
  dressed.dressing = garment.dressing;
  const auto [inner, outer] = std::ranges::minmax_element(dressed.panels, {}, &GarmentPanel::layer);
  if (inner->layer < outer->layer) dressed.touching = garment.layers;
  const TrunkAndLegs& met = body->profile.trunk_and_legs();
  dressed.body_maps = maps_for_layers(spec, dressed, met.surface, cut.body_offset);
  std::string note;
  const std::size_t nodes = system.nodes(), springs = system.springs.size();
  if (const auto& stated = garment.expected; stated && (stated->nodes != nodes || stated->springs != springs))
    note = fmt::format(
        "the mesh has {} nodes and {} springs where the scene states {} and {}: another body, or another "
        "pattern, makes other panels; state what they have",
        nodes, springs, stated->nodes, stated->springs);
  append_sentence(note, body->note);
  append_sentence(note, ignored_parts(met));
  return {std::move(system), std::move(note), std::move(body)};
}

}  // namespace

FittedGarment cut_and_placed(const SceneSpec& spec, const BodyProfile& profile) {
  const double least = JeansMeasures{}.body_offset;
  const AskedMeasures body{profile};
  FittedGarment fitted = cut_and_placed(spec, body, least);
  return garment_of(spec).jeans && fitted.body_offset > least ? cut_and_placed(spec, body, fitted.body_offset)
                                                              : fitted;
}

namespace {

void visit_fields(FieldVisitor& fields, SceneSpec& spec) {
  GarmentSpec& garment = spec.content.emplace<GarmentSpec>();
  visit_body_fields(fields, garment);
  visit_length(fields, {"pixel_m", "Width of a pixel of the maps that cloth collides with, m."},
               garment.pixel_m);
  fields.number(
      {"skin_m",
       "Distance of the maps from the body's surface, m. mssim adds what coarse cloth needs so that "
       "the body does not show between its nodes."},
      garment.skin_m, from(0, largest_length_m));
  constexpr Field jeans_field{"jeans",
                              "Jeans of four panels and six seams that fit the body; mssim measures its "
                              "girths and the height of its crotch."};
  const auto jeans_of = [&](FieldVisitor& jeans) { visit_jeans(jeans, garment.jeans.emplace()); };
  const auto pieces_of = [&](FieldVisitor& pieces) { visit_pieces(pieces, garment.pieces.emplace()); };
  const std::array patterns{
      Section{jeans_field, jeans_of}, Section{{"pieces", "Panels and seams of your own pattern."}, pieces_of},
      Section{{"outfit", "Jeans, and panels and seams of your own pattern."}, [&](FieldVisitor& outfit) {
                outfit.object(jeans_field, Presence::required, jeans_of);
                pieces_of(outfit);
              }}};
  fields.one_of(
      {"pattern",
       "Section that describes the garment: jeans drafted for the body, pieces of your own pattern, "
       "or both."},
      patterns);
  fields.object({"cloth", "Cloth of jeans, and of pieces without their own cloth."}, Presence::required,
                [&](FieldVisitor& cloth) { visit_cloth(cloth, garment.cloth); });
  fields.object({"dressing", "Settings by which the panels are drawn together and draped."},
                Presence::required,
                [&](FieldVisitor& dressing) { visit_dressing(dressing, garment.dressing); });
  fields.object(
      {"layers",
       "Settings of collisions between layers of cloth; without this section, layers pass through each "
       "other. For each layer, the maps of the body lie further out by the thickness. No seam may join two "
       "layers."},
      Presence::optional, [&](FieldVisitor& section) {
        ClothClothSettings& layers = garment.layers.emplace();
        section.number({"thickness_m", "Distance that layers keep, m; more than they approach per step."},
                       layers.thickness, from(1e-6, largest_length_m));
        section.number({"friction", "Coulomb's coefficient of friction between layers."}, layers.friction,
                       from(0, 100));
        section.number(
            {"push_speed_m_per_s",
             "Largest speed at which layers that are too near or have crossed are moved apart, m/s."},
            layers.push_speed, from(0, 1000));
        section.integer({"sweeps", "Sweeps over all contacts per step."}, layers.sweeps, 1, 1000);
      });
  fields.object({"expected", "Size of the cut pattern, for listings."}, Presence::optional,
                [&](FieldVisitor& expected) {
                  MeshSize& size = garment.expected.emplace();
                  expected.integer({"nodes", "Nodes of all panels."}, size.nodes, 4, most_garment_nodes);
                  expected.integer({"springs", "Unique springs of all panels."}, size.springs, 6,
                                   6 * most_garment_nodes);
                });
}

/// Checks the body's axes, and that the pieces have names, curves and not too many nodes.
void check(const SceneSpec& spec) {
  check_body(spec);
  check_pieces(spec);
}

std::optional<SceneCounts> stated(const SceneSpec& spec) {
  const std::optional<MeshSize>& expected = garment_of(spec).expected;
  if (!expected) return std::nullopt;
  return SceneCounts{expected->nodes, expected->springs};
}

/// Measures the body and cuts the garment for it. Throws SceneError if the body cannot be measured or the
/// pattern does not fit together.
///
/// The built scene has the panels at rest around the body, and the maps of the body that they collide with.
/// Its note names the parts of the body that they ignore. Deterministic. Building it throws SceneError if the
/// garment starts below the floor.
SceneParts read(const SceneSpec& spec) {
  const auto body = std::make_shared<const MeasuredBody>(measured_body(spec));
  const auto cut = std::make_shared<const FittedGarment>(cut_and_placed(spec, body->profile));
  SceneParts parts{{cut->system.nodes(), cut->system.springs.size()},
                   [body, cut](const SceneSpec& of) { return built(of, body, *cut); }};
  if (const auto* scan = std::get_if<BodyFile>(&garment_of(spec).body)) {
    const Surface& surface = body->surface;
    parts.files.push_back(spec.file.parent_path() / scan->file);
    parts.files_fnv1a_64 = fnv1a_64(bytes_of(surface.triangles), fnv1a_64(bytes_of(surface.points)));
  }
  return parts;
}

}  // namespace

const SceneKind GarmentSpec::kind{
    .name = "garment",
    .description = "Panels, drawn together around a body along their seams and then draped.",
    .visit_fields = visit_fields,
    .check = check,
    .published_per_spring = {},
    .stated = stated,
    .read = read,
};

}  // namespace mssim
