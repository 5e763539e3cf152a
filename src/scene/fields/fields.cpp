#include "scene/fields/fields.h"

#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "text/text.h"

namespace mssim {

void refuse(const std::filesystem::path& file, std::string_view pointer, const std::string& problem) {
  throw SceneError("{}: {} {}", printable(file.string(), 1000), printable(pointer, 200), problem);
}

void refuse(const std::filesystem::path& file, std::string_view pointer, std::string_view problem,
            const std::exception& error) {
  refuse(file, pointer, fmt::format("{}: {}", problem, printable(error.what(), 1500)));
}

std::string shown_number(double number) {
  // Integers in full (general notation would turn a million into 1e+06), others in the fewest digits.
  const bool whole = std::abs(number) < 1e15 && number == std::trunc(number);
  char text[64];
  const std::to_chars_result end =
      whole ? std::to_chars(text, text + sizeof text, static_cast<std::int64_t>(number))
            : std::to_chars(text, text + sizeof text, number, std::chars_format::general);
  return {text, end.ptr};
}

std::optional<double> stated_floor(const std::string& scene_json) {
  const nlohmann::json scene = nlohmann::json::parse(scene_json, nullptr, false);
  const nlohmann::json::json_pointer place("/floor/height_m");
  const nlohmann::json height = scene.contains(place) ? scene[place] : nlohmann::json();
  return height.is_number() && std::isfinite(height.get<double>()) ? std::optional(height.get<double>())
                                                                   : std::nullopt;
}

}  // namespace mssim
