#pragma once

#include <optional>
#include <string>

namespace mssim {

/// The height of the floor that a scene file states, m; none where it states none, or where `scene_json` is
/// no scene file.
std::optional<double> stated_floor(const std::string& scene_json);

}  // namespace mssim
