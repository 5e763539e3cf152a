#include "garment/scene/garment_cut.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "garment/pattern/jeans.h"
#include "garment/scene/garment_body.h"
#include "geometry/geometry.h"
#include "scene/fields/fields.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

/// Cloth of this radius of curvature, of a limb's, say, must not show the body through the faces between its
/// nodes: their sagitta is h^2 / 8 r.
constexpr double least_curvature_radius_m = 0.04;

/// A trouser leg begins so far outside the leg's middle: its halves are closed around the leg from there
/// without being drawn across the other one.
constexpr double beside_the_leg_m = 0.01;

std::string jeans_pointer(const GarmentSpec& garment) {
  return garment.pieces ? "/garment/outfit/jeans" : "/garment/jeans";
}
/// How far before the body its maps lie, m, for cloth whose cells are about `cell` wide.
double map_offset(const GarmentSpec& garment, double cell) {
  return garment.skin_m + cell * cell / (8 * least_curvature_radius_m);
}

/// Width of a square cell of the average size in the layer where that is largest, m.
double widest_mean_cell(const GarmentPattern& pattern, const GarmentBuild& build) {
  struct Extent {
    double area = 0, nodes = 0;
  };
  std::map<std::uint32_t, Extent> layers;
  for (std::size_t p = 0; p < pattern.panels.size(); ++p) {
    const GarmentPanel& panel = build.garment.panels[p];
    const auto first = build.node_mass.begin() + panel.first_node;
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

/// That the body reaches as far as the jeans do. Throws SceneError, which names the field to change.
void require_body_there(const SceneSpec& spec, const BodyProfile& profile) {
  const JeansMeasures& jeans = garment_of(spec).jeans->measures;
  constexpr double waist_raised = 0.04;  // m, of the jeans' upper edge behind, and room
  if (!profile.has_legs() && std::holds_alternative<BodyFile>(garment_of(spec).body))
    refuse(spec.file, "/garment/surface_file",
           "has no leg on either side of x = 0, where jeans need one: let \"up\", \"facing\" and \"move_m\" "
           "say how it stands (mssim measure finds them)");
  if (jeans.hem_height < profile.lowest())
    refuse_measure(
        spec, "hem_height_m", jeans.hem_height,
        ", and the body begins at the height " + shown(profile.lowest()) + " m: give a higher one");
  if (jeans.waist_height + waist_raised > profile.highest())
    refuse_measure(spec, "waist_height_m", jeans.waist_height,
                   ", and the body ends at the height " + shown(profile.highest()) +
                       " m, but the jeans' back rises 0.04 m above their waist: give a lower one");
}

/// What is wrong with jeans whose panels, which nobody drew, cannot be cut.
std::string uncut_jeans(const JeansMeasures& jeans, const BodyProfile& profile) {
  const auto girth_at = [&](double height) {
    const double millimetres = std::round(1000 * profile.hull_girth(height));
    return shown(millimetres / 1000) + " m around at the height " + shown(height);
  };
  return "cannot be cut for this body: it measures " + girth_at(jeans.hip_height) + " (hip_height_m) and " +
         girth_at(jeans.waist_height) + " (waist_height_m), and parts into legs at " +
         shown(profile.crotch_height()) +
         " m; give the heights of its hip and waist, and knee_height_m and hem_height_m evenly below (mssim "
         "measure finds them)";
}

using OfHeight = std::function<double(double height)>;

/// Wraps a function so that it computes a value once for each height. Copies remember together.
OfHeight remembered(OfHeight function) {
  return [function = std::move(function),
          known = std::make_shared<std::unordered_map<double, double>>()](double height) {
    const auto found = known->find(height);
    return found != known->end() ? found->second : known->emplace(height, function(height)).first->second;
  };
}

/// What patterns ask of a body. They ask for the same heights again: for panels that are mirror images, and
/// when they are cut once more for another offset.
struct AskedMeasures {
  const BodyProfile& profile;
  OfHeight girth = remembered([&of = profile](double y) { return of.hull_girth(y); });
  /// Before the middle of the legs, above which the side seams lie.
  OfHeight front_share = remembered(
      [&of = profile](double y) { return of.front_share(y, of.leg_middle(of.crotch_height()).z); });
  OfHeight leg_x = remembered([&of = profile](double y) { return of.leg_middle(y).x; });
  BodyDepth depth{remembered([&of = profile](double y) { return of.front(y); }),
                  remembered([&of = profile](double y) { return of.back(y); })};
};

/// Jeans for a body that is as much wider all round as its maps lie before it.
GarmentPattern jeans_for(const GarmentSpec& garment, const AskedMeasures& body, double body_offset) {
  JeansMeasures measures = garment.jeans->measures;
  measures.body_offset = body_offset;
  measures.girth = body.girth;
  measures.front_share = body.front_share;
  measures.crotch_length = [&of = body.profile](double y) { return of.crotch_length(y); };
  measures.crotch_height = body.profile.crotch_height();
  return jeans_pattern(measures, garment.jeans->nodes, garment.cloth,
                       [leg_x = body.leg_x](double height) { return leg_x(height) + beside_the_leg_m; });
}

/// Throws SceneError, which names the panel or seam that cannot be made.
GarmentBuild cut_and_placed(const SceneSpec& spec, const GarmentPattern& pattern, const AskedMeasures& body,
                            const GarmentPattern& jeans) {
  const GarmentSpec& garment = garment_of(spec);
  try {
    return build_garment(pattern, body.depth);
  } catch (const PatternError& error) {
    const bool is_panel = error.part == PatternError::Part::panel;
    const std::size_t of_jeans = is_panel ? jeans.panels.size() : jeans.seams.size();
    if (error.index < of_jeans)
      refuse(spec.file, jeans_pointer(garment),
             error.folded ? uncut_jeans(garment.jeans->measures, body.profile)
                          : "does not fit: " + printable(error.what(), 1500));
    refuse(spec.file,
           pieces_pointer(garment) + (is_panel ? "/panels/" : "/seams/") +
               std::to_string(error.index - of_jeans),
           "does not fit: " + printable(error.what(), 1500));
  }
}

FittedGarment cut_and_placed(const SceneSpec& spec, const AskedMeasures& body, double body_offset) {
  const GarmentSpec& garment = garment_of(spec);
  GarmentPattern jeans;
  if (garment.jeans) require_body_there(spec, body.profile);
  try {
    if (garment.jeans) jeans = jeans_for(garment, body, body_offset);
  } catch (const InputError& error) {
    refuse(spec.file, jeans_pointer(garment), "does not fit: " + printable(error.what(), 1500));
  }
  GarmentPattern pattern = jeans;
  if (garment.pieces) append_pieces(*garment.pieces, garment.cloth, pattern);
  GarmentBuild build = cut_and_placed(spec, pattern, body, jeans);
  const double cell = widest_mean_cell(pattern, build);
  return {std::move(build), map_offset(garment, cell)};
}

}  // namespace

std::string pieces_pointer(const GarmentSpec& garment) {
  return garment.jeans ? "/garment/outfit" : "/garment/pieces";
}

FittedGarment cut_and_placed(const SceneSpec& spec, const BodyProfile& profile) {
  const double least = JeansMeasures{}.body_offset;
  const AskedMeasures body{profile};
  FittedGarment fitted = cut_and_placed(spec, body, least);
  return garment_of(spec).jeans && fitted.body_offset > least ? cut_and_placed(spec, body, fitted.body_offset)
                                                              : fitted;
}

}  // namespace mssim
