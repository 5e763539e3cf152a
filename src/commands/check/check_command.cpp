#include "commands/check/check_command.h"

#include <algorithm>
#include <iostream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "commands/check/scene_report.h"
#include "commands/shared/choices.h"
#include "commands/shared/exit_code.h"
#include "commands/shared/prepared_scene.h"
#include "output/tables/listing.h"
#include "scene/scene_file.h"

namespace mssim {
namespace {

struct CheckOptions {
  std::vector<std::string> scenes;
  ListingFormat format = ListingFormat::table;
};

/// For a reader: what the scene is in a line of its own.
std::string as_tables(const SceneReport& report) {
  return to_text({report.scene}, ListingFormat::table) + '\n' +
         to_text(report.combinations, ListingFormat::table);
}

/// Each combination with what its scene is.
Listing as_rows(const SceneReport& report) {
  Listing rows;
  for (const nlohmann::ordered_json& combination : report.combinations) {
    nlohmann::ordered_json row = report.scene;
    row.update(combination);
    rows.push_back(std::move(row));
  }
  return rows;
}

int run(const CheckOptions& options) {
  Listing rows;
  std::string tables;
  for (const std::string& name : options.scenes) {
    const PreparedScene scene = prepare_scene(find_scene(name));
    const SceneReport report = report_on(scene);
    for (const std::string& warning : report.warnings)
      std::cerr << "mssim: " << scene.spec.name << ": " << warning << '\n';
    tables += (tables.empty() ? "" : "\n") + as_tables(report);
    std::ranges::move(as_rows(report), std::back_inserter(rows));
  }
  std::cout << (options.format == ListingFormat::table ? tables : to_text(rows, options.format));
  return exit_ok;
}

}  // namespace

std::function<int()> declare_check(Arguments& arguments) {
  const auto options = std::make_shared<CheckOptions>();
  add_scenes(arguments, "SCENE", options->scenes, "Scenes to check: names (see mssim list scenes) or files")
      .required();
  declare_listing_format(arguments, options->format);
  return [options] { return run(*options); };
}

}  // namespace mssim
