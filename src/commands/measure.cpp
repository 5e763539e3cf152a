#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "application/console.h"
#include "commands/command.h"
#include "commands/options.h"
#include "garment/body/body_profile.h"
#include "garment/body/stance.h"
#include "garment/pattern/jeans.h"
#include "garment/scene/garment_scene.h"
#include "garment/spec/garment_spec.h"
#include "geometry/geometry.h"
#include "geometry/surface.h"
#include "mesh/surface_file.h"
#include "output/tables/table.h"
#include "platform/files.h"
#include "scene/fields/fields.h"
#include "scene/scene_file.h"
#include "scene/scene_kinds.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

namespace fs = std::filesystem;

/// A measured body from a file: its description in a scene file, and the body itself.
struct MeasuredFile {
  BodyFile body;
  BodyProfile profile;
  BodyLandmarks landmarks;
};

/// A length for display, m, rounded to a tenth of a millimetre.
double to_tenths(double metres) { return std::round(1e4 * metres) / 1e4; }

Vec3d to_tenths(const Vec3d& point) {
  return {to_tenths(point.x) + 0.0, to_tenths(point.y) + 0.0, to_tenths(point.z) + 0.0};
}

/// The results of `mssim measure` for a body: rows of measure, value, unit and note.
class BodyListing {
 public:
  /// The rest: the sources of the three values.
  void add_stance(const BodyStance& stance, const std::string& of_unit, const std::string& of_up,
                  const std::string& of_facing) {
    const auto units = length_units();
    const auto* unit = found_in(units, stance.unit_m, &LengthUnit::metres);
    add("unit", stance.unit_m, "m", unit ? fmt::format("{}, {}", unit->name, of_unit) : of_unit);
    add("up", up_axis_names.at(static_cast<std::size_t>(stance.up)), "", of_up);
    add("facing", facing_names.at(static_cast<std::size_t>(stance.facing)), "", of_facing);
    if (stance.turn_deg != 0)
      add("turn", stance.turn_deg, "degrees", "about the upright axis, towards its left");
    if (!(stance.move == Vec3d{}))
      add("move", place(stance.move), "m",
          "to its left, up, ahead: legs on either side of x = 0, feet on the floor");
  }

  /// `what`: how they are treated.
  void add_openings(std::span<const Opening> openings, const std::string& what) {
    for (std::size_t i = 0; i < openings.size(); ++i)
      add(fmt::format("opening_{}", i + 1), to_tenths(openings[i].size), "m",
          fmt::format("{} edges around {}, {}", openings[i].edges(), place(to_tenths(openings[i].centre)),
                      what));
  }

  void add_measures(const BodyProfile& profile, const BodyLandmarks& landmarks) {
    add("height", to_tenths(profile.highest() - profile.lowest()), "m");
    constexpr const char* no_trunk = "the body ends below that height";
    constexpr const char* no_leg = "the legs are not apart there";
    add_landmark("waist", landmarks.waist, no_trunk);
    add_landmark("hip", landmarks.hip, no_trunk);
    add("crotch_height", to_tenths(landmarks.crotch_height), "m");
    add_landmark("thigh", landmarks.thigh, no_leg);
    add_landmark("knee", landmarks.knee, no_leg);
    add_landmark("ankle", landmarks.ankle, no_leg);
  }

  const Table& rows() const { return rows_; }

 private:
  void add(const std::string& measure, Cell value, const std::string& unit, const std::string& note = {}) {
    const auto text = [](const std::string& words) { return words.empty() ? Cell() : Cell(words); };
    rows_.add(
        {{"measure", measure}, {"value", std::move(value)}, {"unit", text(unit)}, {"note", text(note)}});
  }

  /// `no_girth`: why there is none.
  void add_landmark(const std::string& name, const Landmark& landmark, const char* no_girth) {
    add(name + "_height", to_tenths(landmark.height), "m",
        landmark.by_proportion ? "estimated by proportion" : "");
    add(name + "_girth", landmark.girth ? Cell(to_tenths(*landmark.girth)) : Cell(), "m",
        landmark.girth ? "" : no_girth);
  }

  Table rows_;
};

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

/// The template's garment for another body, without what it states for its own body.
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

/// The mass of a node is proportional to the area of its cell, which is smaller in smaller jeans of as many
/// nodes; dt is proportional to the square root of the mass. Rounds down to two digits, and never exceeds the
/// template's tested dt.
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

/// Text of a scene file to start from: jeans4k for this body. Cloth and dressing are that scene's; dt is
/// scaled with the size of the jeans, which have as many nodes. `file` is the path of the scene. Throws
/// SceneError for content that a scene file cannot hold, such as a name that is not UTF-8.
std::string jeans_scene(const fs::path& file, const MeasuredFile& found) {
  const JeansMeasures jeans = jeans_for_body(found.profile, found.landmarks);
  try {
    const SceneSpec example = find_scene("jeans4k");
    ordered_json scene = ordered_json::parse(example.source);
    scene.erase("$schema");
    scene["description"] = "Jeans of about 4,000 nodes for a body that mssim measure has measured";
    scene["dt_s"] = shorter_dt(example.dt_s.value(), jeans, found.landmarks.hip.girth.value_or(0));
    scene["garment"] = garment_for(found.body, scene.at("garment"));
    ordered_json& section = scene["garment"]["jeans"];
    section["waist_height_m"] = jeans.waist_height;
    section["hip_height_m"] = jeans.hip_height;
    section["knee_height_m"] = jeans.knee_height;
    section["hem_height_m"] = jeans.hem_height;
    section["knee_m"] = jeans.knee;
    section["hem_m"] = jeans.hem;
    section["hip_ease_m"] = jeans.hip_ease;
    section["thigh_ease_m"] = jeans.thigh_ease.value();
    section["waist_ease_m"] = jeans.waist_ease;
    section["crotch_ease_m"] = jeans.crotch_ease;
    // As people dress: they hold the waistband, and the legs hang from it.
    ordered_json& dressing = scene["garment"]["dressing"];
    dressing["held"] = "upper edge";
    dressing["seaming_gravity"] = 1;
    // Held cloth yields less, so seams close later. A seam that is open when its time is up is sewn across
    // the gap, and friction then keeps the cloth next to it stretched.
    constexpr double more = 2;
    for (const char* key : {"seam_force_n_per_m", "longest_seaming_s"})
      dressing[key] = more * dressing.at(key).get<double>();
    std::string text = scene.dump(2) + '\n';
    parse_scene(file, text);
    return text;
  } catch (const ordered_json::exception& error) {
    throw SceneError("{}: the body's file {} cannot be named in a scene file ({}): give it a name in UTF-8",
                     printable(file.string(), 1000), printable(found.body.file, 1000),
                     printable(error.what(), 200));
  }
}

/// Largest opening to close: eyes, mouth, a neck without its head; narrower than any waist.
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
  throw UsageError("--unit is \"{}\": give {}or the metres in one unit of the file", printable(text, 100),
                   unit_names());
}

/// An existing scene is replaced only on request, and a body never.
void require_free_scene(const MeasureOptions& options) {
  const fs::path scene = options.scene;
  if (scene.extension() != ".json")
    throw UsageError("--scene is {}: give a file that ends in .json, as mssim run requires",
                     printable(options.scene, 1000));
  if (escaped(options.body) != options.body)
    throw UsageError(printable(options.body, 1000) +
                     " has characters that a scene file cannot hold: give the file another name");
  require_free(scene, "--scene", options.overwrite);
}

void print(const MeasureOptions& options, const BodyListing& listing) {
  std::cout << to_text(listing.rows(), options.format);
}

void tell_of_ignored_parts(const BodyProfile& profile) {
  const std::string ignored = ignored_parts(profile.trunk_and_legs());
  if (!ignored.empty()) tell(ignored);
}

/// The landmarks of a body. Warns if the crotch is too low for a person.
BodyLandmarks found_landmarks(const BodyProfile& profile) {
  const BodyLandmarks landmarks = find_landmarks(profile);
  constexpr double least = 0.43;  // of the height; people of tests/support/persons.csv have 0.46 to 0.52
  const double share = landmarks.crotch_height / (profile.highest() - profile.lowest());
  if (share < least)
    tell(
        "not certain of crotch_height: it is {:.2f} of the height, and people's is {} or more; if the thighs "
        "touch, give a body with its thighs apart",
        share, least);
  return landmarks;
}

/// Measures the body of a file, and prints the results as far as it gets. Throws InputError.
MeasuredFile measure_file(const MeasureOptions& options) {
  auto [surface, note] = read_surface(options.body);
  if (!note.empty()) tell(printable(note, 1000));
  require_joined(surface);
  const StanceGuess guess = guess_stance(surface, {unit_given(options.unit), options.up, options.facing});
  for (const std::string& doubt : guess.doubts) tell("not certain of {}", printable(doubt, 1000));
  surface = stood_up(std::move(surface), guess.stance);
  BodyListing listing;
  const auto source = [](bool is_given) { return is_given ? "given" : "found"; };
  listing.add_stance(guess.stance, source(!options.unit.empty()), source(options.up.has_value()),
                     source(options.facing.has_value()));
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
    if (!profile.has_legs())  // the profile would speak of axes that are not the file's
      throw InputError(
          "it does not divide into a left and a right leg if it is upright in {} and faces {}: "
          "correct these with --up and --facing, or give a body whose legs are apart",
          up_axis_names.at(static_cast<std::size_t>(guess.stance.up)),
          facing_names.at(static_cast<std::size_t>(guess.stance.facing)));
    const BodyLandmarks landmarks = found_landmarks(profile);
    listing.add_measures(profile, landmarks);
    print(options, listing);
    return {body, std::move(profile), landmarks};
  } catch (const InputError&) {
    print(options, listing);
    throw;
  }
}

/// Writes a scene for the body, and reports whether its jeans can be drafted.
int write_scene(const MeasureOptions& options, MeasuredFile found) {
  const fs::path scene = options.scene;
  // A link to the body may change its target later.
  const fs::path folder = fs::weakly_canonical(fs::absolute(scene).parent_path());
  found.body.file = fs::absolute(options.body).lexically_relative(folder).string();
  const std::string text = jeans_scene(scene, found);
  write_file_atomically(target_of(scene), text);
  try {
    build_system(load_scene(scene));
  } catch (const SceneError& error) {
    tell("{} is written, but does not work yet: {}", escaped(options.scene), escaped(error.what()));
    return exit_not_verified;
  }
  tell("wrote {}; mssim run --scene {} dresses it", escaped(options.scene),
       escaped(shell_word(options.scene)));
  return exit_ok;
}

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
  const char* const source = "from the scene";
  listing.add_stance(file ? file->stance : BodyStance{}, source, source, source);
  listing.add_measures(body, found_landmarks(body));
  print(options, listing);
  return exit_ok;
}

int run_measure(const MeasureOptions& options) {
  try {
    const std::string extension = to_lower(fs::path(options.body).extension().string());
    if (extension != ".obj" && extension != ".stl") {
      const bool is_file = !extension.empty() || is_path_of_scene(options.body);
      if (is_file && extension != ".json")
        throw UsageError(
            printable(options.body, 1000) +
            " ends in neither .obj nor .stl: give a person's surface in one of those formats, or the "
            "scene of a garment, which ends in .json");
      return measure_scene(options);
    }
    if (!options.scene.empty()) require_free_scene(options);
    MeasuredFile found = measure_file(options);
    return options.scene.empty() ? exit_ok : write_scene(options, std::move(found));
  } catch (const InputError& error) {
    const std::string_view problem = error.what();
    if (problem.starts_with(options.body)) throw UsageError(printable(problem, 1500));
    throw UsageError(printable(options.body, 1000) + " cannot be measured: " + printable(problem, 1500));
  }
}

/// The words of a table as choices of an optional value.
template <class Value, std::size_t n>
std::map<std::string, std::optional<Value>> choices_of(const std::array<std::string_view, n>& names) {
  std::map<std::string, std::optional<Value>> choices;
  for (std::size_t i = 0; i < n; ++i) choices[std::string(names.at(i))] = static_cast<Value>(i);
  return choices;
}

}  // namespace

std::function<int()> declare_measure(Arguments& arguments) {
  const auto options = std::make_shared<MeasureOptions>();
  arguments
      .add("BODY FILE|NAME", options->body, "A person's surface, an .obj or .stl file; or a garment's scene")
      .offers(scene_names)
      .required();
  arguments.add(
      "--unit UNIT", options->unit,
      fmt::format("Unit of the file: {}or its metres (default: detected from the height)", unit_names()));
  arguments.add_choice("--up", options->up, choices_of<UpAxis>(up_axis_names),
                       "Upright axis of the body in the file: y or z (default: detected)");
  arguments.add_choice("--facing", options->facing, choices_of<Facing>(facing_names),
                       "Direction that the body faces: +x, -x, +y, -y, +z or -z (default: detected)");
  arguments.add_flag("--close-holes", options->close_holes,
                     "Close openings of the surface that are up to 0.2 m across");
  const Argument scene =
      arguments.add("--scene FILE", options->scene, "Scene file to write: jeans for the body, for mssim run");
  arguments.add_flag("--overwrite", options->overwrite, "Replace the scene file if it exists").needs(scene);
  declare_listing_format(arguments, options->format);
  return [options] { return run_measure(*options); };
}

}  // namespace mssim
