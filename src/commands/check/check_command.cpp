#include "commands/check/check_command.h"

#include <algorithm>
#include <iostream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "commands/check/scene_report.h"
#include "commands/shared/choices.h"
#include "commands/shared/prepared_scene.h"
#include "output/tables/table.h"
#include "scene/scene_file.h"
#include "text/error.h"

namespace mssim {
namespace {

struct CheckOptions {
  std::vector<std::string> scenes;
  ListingFormat format = ListingFormat::table;
};

/// For a reader: what the scene is in a line of its own.
std::string as_tables(const SceneReport& report) {
  return to_text(report.scene) + '\n' + to_text(report.combinations);
}

/// Adds each combination with what its scene is.
void add_rows(Table& rows, const SceneReport& report) {
  rows.columns = report.scene.columns;
  std::ranges::copy(report.combinations.columns, std::back_inserter(rows.columns));
  for (const std::vector<Cell>& combination : report.combinations.rows)
    std::ranges::copy(combination, std::back_inserter(rows.rows.emplace_back(report.scene.rows.front())));
}

int run(const CheckOptions& options) {
  Table rows;
  std::string tables;
  for (const std::string& name : options.scenes) {
    const PreparedScene scene = prepare_scene(find_scene(name));
    const SceneReport report = report_on(scene);
    for (const std::string& warning : report.warnings)
      std::cerr << "mssim: " << scene.spec.name << ": " << warning << '\n';
    tables += (tables.empty() ? "" : "\n") + as_tables(report);
    add_rows(rows, report);
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
