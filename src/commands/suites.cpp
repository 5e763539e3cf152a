#include "commands/suites.h"

#include <array>

namespace mssim {
namespace {

constexpr std::string_view every_suite = "all";

constexpr std::array<std::string_view, 6> cloths{"cloth2500", "cloth4900", "cloth10k",
                                                 "cloth40k",  "cloth200k", "cloth350k"};
constexpr std::array<std::string_view, 9> single_bodies{"box-small",    "box-medium",    "box-large",
                                                        "sphere-small", "sphere-medium", "sphere-large",
                                                        "torus-small",  "torus-medium",  "torus-large"};
constexpr std::array<std::string_view, 6> body_scenes{"bodies3858",  "bodies4737",  "bodies7282",
                                                      "bodies10223", "bodies20587", "bodies38233"};

constexpr std::array<Suite, 3> table{{
    {"table1", true, cloths},
    {"table2", false, single_bodies},
    {"table3", true, body_scenes},
}};

}  // namespace

std::span<const Suite> suites() { return table; }

std::vector<std::string> suite_names() {
  std::vector<std::string> names;
  for (const Suite& suite : table) names.emplace_back(suite.name);
  names.emplace_back(every_suite);
  return names;
}

std::vector<std::string> scenes_of_suite(std::string_view name, bool timed) {
  std::vector<std::string> scenes;
  for (const Suite& suite : table)
    if (suite.timed == timed && (name == every_suite || name == suite.name))
      scenes.insert(scenes.end(), suite.scenes.begin(), suite.scenes.end());
  return scenes;
}

}  // namespace mssim
