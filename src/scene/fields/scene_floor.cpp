#include "scene/fields/scene_floor.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace mssim {

std::optional<double> stated_floor(const std::string& scene_json) {
  const nlohmann::json scene = nlohmann::json::parse(scene_json, nullptr, false);
  if (!scene.is_object()) return std::nullopt;
  const auto floor = scene.find("floor");
  if (floor == scene.end() || !floor->is_object()) return std::nullopt;
  const auto height = floor->find("height_m");
  if (height == floor->end() || !height->is_number() || !std::isfinite(height->get<double>()))
    return std::nullopt;
  return height->get<double>();
}

}  // namespace mssim
