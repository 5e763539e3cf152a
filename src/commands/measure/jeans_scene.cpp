#include "commands/measure/jeans_scene.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "scene/fields/fields.h"
#include "scene/scene_file.h"
#include "text/text.h"

namespace mssim {
namespace {

using nlohmann::ordered_json;

ordered_json section_of(const BodyFile& body) {
  ordered_json section{{"file", body.file},
                       {"unit_m", body.stance.unit_m},
                       {"up", up_axis_names.at(static_cast<std::size_t>(body.stance.up))},
                       {"facing", facing_names.at(static_cast<std::size_t>(body.stance.facing))}};
  if (body.stance.turn_deg != 0) section["turn_deg"] = body.stance.turn_deg;
  const Vec3d& move = body.stance.move;
  section["move_m"] = {move.x, move.y, move.z};
  if (body.close_holes_m) section["close_holes_m"] = *body.close_holes_m;
  return section;
}

/// The template's garment with another body, and without what it states for its own.
ordered_json garment_for(const BodyFile& body, const ordered_json& garment) {
  ordered_json changed;
  for (const auto& [key, value] : garment.items()) {
    if (key == "mannequin")
      changed["surface_file"] = section_of(body);
    else if (key != "expected")
      changed[key] = value;
  }
  changed["body"] = "surface_file";
  return changed;
}

/// A node of as many in smaller jeans is lighter by as much as its cell is smaller, and dt goes with the root
/// of its mass. Two digits, downwards; no longer than the template's, which is tried.
double shorter_dt(double dt_s, const JeansMeasures& jeans, double hip_girth) {
  const JeansMeasures reference;
  constexpr double reference_hip = 0.98;
  const double area = (jeans.waist_height - jeans.hem_height) * hip_girth;
  const double reference_area = (reference.waist_height - reference.hem_height) * reference_hip;
  const double dt = dt_s * std::min(1.0, std::sqrt(area / reference_area));
  const double digits_per_s = std::pow(10, 1 - std::floor(std::log10(dt)));
  constexpr double rounding = 1e-9;
  return std::floor(dt * digits_per_s * (1 + rounding)) / digits_per_s;
}

}  // namespace

std::string jeans_scene(const std::filesystem::path& file, const MeasuredJeans& jeans) {
  try {
    const SceneSpec example = find_scene("jeans4k");
    ordered_json scene = ordered_json::parse(example.source);
    scene.erase("$schema");
    scene["description"] = "Jeans of about 4,000 nodes for a body that mssim measure has measured";
    scene["dt_s"] = shorter_dt(example.dt_s.value(), jeans.measures, jeans.hip_girth);
    scene["garment"] = garment_for(jeans.body, scene.at("garment"));
    ordered_json& section = scene["garment"]["jeans"];
    section["waist_height_m"] = jeans.measures.waist_height;
    section["hip_height_m"] = jeans.measures.hip_height;
    section["knee_height_m"] = jeans.measures.knee_height;
    section["hem_height_m"] = jeans.measures.hem_height;
    section["knee_m"] = jeans.measures.knee;
    section["hem_m"] = jeans.measures.hem;
    section["waist_ease_m"] = jeans.measures.waist_ease;
    std::string text = scene.dump(2) + '\n';
    parse_scene(file, text);
    return text;
  } catch (const ordered_json::exception& error) {
    throw SceneError(printable(file.string(), 1000) + ": the body's file " +
                     printable(jeans.body.file, 1000) + " cannot be named in a scene file (" +
                     printable(error.what(), 200) + "): give it a name in UTF-8");
  }
}

}  // namespace mssim
