#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>

#include "scene/scene_file.h"
#include "tests/support/scene_files.h"

namespace mssim {
namespace {

using nlohmann::json;

TEST(SceneSchema, IsCommittedAsTheFieldsOfTheReaderAre) {
  EXPECT_EQ(text_of(source_file("scenes/scene.schema.json")), scene_schema())
      << "write it anew, with mssim list schema";
}

/// What a field's description says where its key ends so; the longest endings first.
constexpr std::array<std::pair<std::string_view, std::string_view>, 12> units{{
    {"_kg_per_m2", "kg/m^2"},
    {"_kg_per_m3", "kg/m^3"},
    {"_m3", "m^3"},
    {"_rad_per_s", "rad/s"},
    {"_deg", "degrees"},
    {"_n_s_per_m", "N s/m"},
    {"_n_per_m", "N/m"},
    {"_m_per_s2", "m/s^2"},
    {"_m_per_s", "m/s"},
    {"_per_s", "1/s"},
    {"_m", ", m"},
    {"_s", ", s"},
}};

/// Checks an object's description and those of all its fields. Returns how many of them have a unit.
int check_descriptions(const json& object, const std::string& place) {
  const auto described = [](const json& schema) { return schema.value("description", std::string()); };
  EXPECT_GT(described(object).size(), 10U) << place;
  int with_unit = 0;
  for (const auto& [key, field] : object.at("properties").items()) {
    const std::string description = described(field);
    EXPECT_GT(description.size(), 10U) << place << '/' << key;
    const auto unit = std::ranges::find_if(
        units, [name = std::string_view(key)](const auto& row) { return name.ends_with(row.first); });
    if (unit != units.end()) {
      ++with_unit;
      EXPECT_NE(description.find(unit->second), std::string::npos) << place << '/' << key;
    }
    const json& nested = field.contains("items") ? field["items"] : field;
    if (nested.contains("properties")) with_unit += check_descriptions(nested, place + '/' + key);
  }
  return with_unit;
}

TEST(SceneSchema, DescribesEveryFieldWithItsUnit) {
  EXPECT_GT(check_descriptions(json::parse(scene_schema()), ""), 0);
}

}  // namespace
}  // namespace mssim
