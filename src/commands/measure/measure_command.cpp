#include "commands/measure/measure_command.h"

#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "commands/measure/body_listing.h"
#include "commands/measure/jeans_scene.h"
#include "commands/shared/choices.h"
#include "garment/body/stance.h"
#include "garment/pattern/jeans.h"
#include "garment/scene/garment_body.h"
#include "mesh/surface_file.h"
#include "platform/files.h"
#include "scene/fields/fields.h"
#include "scene/scene_file.h"
#include "scene/scene_kinds.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

namespace fs = std::filesystem;

/// Eyes, mouth, a neck without its head; narrower than any waist.
constexpr double largest_closed_m = 0.2;

struct MeasureOptions {
  std::string body;
  std::string unit;
  std::optional<UpAxis> up;
  std::optional<Facing> facing;
  bool close_holes = false;
  std::string scene;
  bool overwrite = false;
  ListingFormat format = ListingFormat::table;
};

std::optional<double> unit_given(const std::string& text) {
  if (text.empty()) return std::nullopt;
  for (const LengthUnit& unit : length_units())
    if (unit.name == text) return unit.metres;
  if (const auto metres = number_in<double>(text); metres && *metres > 0 && *metres <= 1e6) return metres;
  throw UsageError("--unit is \"" + printable(text, 100) + "\": give " + unit_names() +
                   "or the metres in one unit of the file");
}

/// A scene is not replaced unasked, and a body never.
void require_free(const MeasureOptions& options) {
  const fs::path scene = options.scene;
  if (scene.extension() != ".json")
    throw UsageError("--scene is " + printable(options.scene, 1000) +
                     ": give a file that ends in .json, as mssim run requires");
  if (escaped(options.body) != options.body)
    throw UsageError(printable(options.body, 1000) +
                     " has characters that a scene file cannot hold: give the file another name");
  if (fs::exists(scene) && !options.overwrite)
    throw UsageError(printable(options.scene, 1000) +
                     " already exists: give another --scene, or --overwrite to replace it");
}

/// A body that has been measured: what its scene file says of it, and what it is.
struct MeasuredFile {
  BodyFile body;
  BodyProfile profile;
  BodyLandmarks landmarks;
};

void tell(const MeasureOptions& options, const BodyListing& listing) {
  std::cout << to_text(listing.rows(), options.format);
}

void tell_of_ignored_parts(const BodyProfile& profile) {
  const std::string ignored = ignored_parts(profile.trunk_and_legs());
  if (!ignored.empty()) std::cerr << "mssim: " << ignored << '\n';
}

/// Measures the body of a file, printing what is found as far as it goes. Throws InputError.
MeasuredFile measure_file(const MeasureOptions& options) {
  auto [surface, note] = read_surface(options.body);
  if (!note.empty()) std::cerr << "mssim: " << printable(note, 1000) << '\n';
  require_joined(surface);
  const StanceGuess guess = guess_stance(surface, {unit_given(options.unit), options.up, options.facing});
  for (const std::string& doubt : guess.doubts)
    std::cerr << "mssim: not certain of " << printable(doubt, 1000) << '\n';
  surface = stood_up(std::move(surface), guess.stance);
  BodyListing listing;
  listing.add_stance(guess.stance, "found");
  BodyFile body{options.body, guess.stance, std::nullopt};
  try {
    std::vector<Opening> openings = openings_of(surface);
    if (options.close_holes && !openings.empty()) {
      close_openings(surface, largest_closed_m);
      body.close_holes_m = largest_closed_m;
    }
    listing.add_openings(openings, options.close_holes ? "closed" : "open");
    if (!openings.empty() && !options.close_holes)
      throw InputError(openings.size() == 1
                           ? "it has 1 opening: close it where the surface was made, or give --close-holes"
                           : "it has " + std::to_string(openings.size()) +
                                 " openings: close them where the surface was made, or give --close-holes");
    BodyProfile profile(surface, options.body);
    tell_of_ignored_parts(profile);
    const BodyLandmarks landmarks = find_landmarks(profile);
    listing.add_measures(profile, landmarks);
    tell(options, listing);
    return {body, std::move(profile), landmarks};
  } catch (const InputError&) {
    tell(options, listing);
    throw;
  }
}

/// Writes a scene for the body, and says whether its jeans can be cut.
int write_scene(const MeasureOptions& options, MeasuredFile found) {
  const fs::path scene = options.scene;
  found.body.file = fs::relative(options.body, fs::absolute(scene).parent_path()).string();
  const std::string text = jeans_scene(scene, {found.body, jeans_for_body(found.profile, found.landmarks),
                                               found.landmarks.hip.girth.value_or(0)});
  write_file_atomically(target_of(scene), text);
  try {
    build_system(load_scene(scene));
  } catch (const SceneError& error) {
    std::cerr << "mssim: " << escaped(options.scene)
              << " is written, but does not work yet: " << escaped(error.what()) << '\n';
    return exit_not_verified;
  }
  const std::string scene_name = escaped(options.scene);
  std::cerr << "mssim: wrote " << scene_name << "; mssim run --scene " << scene_name << " dresses it\n";
  return exit_ok;
}

std::string extension_of(const std::string& file) { return to_lower(fs::path(file).extension().string()); }

int measure_scene(const MeasureOptions& options) {
  if (!options.unit.empty() || options.up || options.facing || options.close_holes || !options.scene.empty())
    throw UsageError(printable(options.body, 1000) +
                     " is a scene, not an .obj or .stl file, and says how its body stands: leave out --unit, "
                     "--up, --facing, --close-holes and --scene");
  const SceneSpec spec = find_scene(options.body);
  const auto* garment = std::get_if<GarmentSpec>(&spec.content);
  if (garment == nullptr)
    throw UsageError(spec.name +
                     " is a scene without a body to dress: give a garment's, or an .obj or .stl file");
  const auto* file = std::get_if<BodyFile>(&garment->body);
  const BodyProfile body = measured_body(spec).profile;
  tell_of_ignored_parts(body);
  BodyListing listing;
  listing.add_stance(file ? file->stance : BodyStance{}, "by the scene");
  listing.add_measures(body, find_landmarks(body));
  tell(options, listing);
  return exit_ok;
}

int run_measure(const MeasureOptions& options) {
  try {
    const std::string extension = extension_of(options.body);
    if (extension != ".obj" && extension != ".stl") {
      const bool is_file = !extension.empty() || is_path_of_scene(options.body);
      if (is_file && extension != ".json")
        throw UsageError(
            printable(options.body, 1000) +
            " ends in neither .obj nor .stl: give a person's surface in one of those formats, or the "
            "scene of a garment, which ends in .json");
      return measure_scene(options);
    }
    if (!options.scene.empty()) require_free(options);
    MeasuredFile found = measure_file(options);
    return options.scene.empty() ? exit_ok : write_scene(options, std::move(found));
  } catch (const InputError& error) {
    throw UsageError(printable(options.body, 1000) + " cannot be measured: " + printable(error.what(), 1500));
  }
}

/// The words of a table, as choices that set an optional.
template <class Value, std::size_t n>
std::map<std::string, std::optional<Value>> choices_of(const std::array<std::string_view, n>& names) {
  std::map<std::string, std::optional<Value>> choices;
  for (std::size_t i = 0; i < n; ++i) choices[std::string(names.at(i))] = static_cast<Value>(i);
  return choices;
}

}  // namespace

std::function<int()> declare_measure(Arguments& arguments) {
  const auto options = std::make_shared<MeasureOptions>();
  arguments.add("BODY", options->body, "A person's surface, an .obj or .stl file; or a garment's scene")
      .required();
  arguments
      .add("--unit", options->unit,
           "Unit of the file: " + unit_names() + "or its metres (default: found from the height)")
      .value_name("UNIT");
  arguments.add_choice("--up", options->up, choices_of<UpAxis>(up_axis_names),
                       "Axis of the file along which the body stands: y or z (default: found)");
  arguments.add_choice("--facing", options->facing, choices_of<Facing>(facing_names),
                       "Where the body looks: +x, -x, +y, -y, +z or -z (default: found)");
  arguments.add_flag("--close-holes", options->close_holes,
                     "Fill openings of the surface that are up to 0.2 m across");
  const Argument scene =
      arguments.add("--scene", options->scene, "Scene file to write: jeans for the body, for mssim run")
          .value_name("FILE");
  arguments.add_flag("--overwrite", options->overwrite, "Replace the scene file if it exists").needs(scene);
  declare_listing_format(arguments, options->format);
  return [options] { return run_measure(*options); };
}

}  // namespace mssim
