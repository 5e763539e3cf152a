#include <array>
#include <utility>
#include <vector>

#include "garment/body/stance.h"
#include "garment/scene/garment_scene.h"
#include "geometry/geometry.h"
#include "geometry/surface.h"
#include "mesh/surface_file.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

void visit_girth(FieldVisitor& fields, std::string_view key, GirthAt& girth) {
  const std::string part(key);
  fields.object({key, fmt::format("Girth of the {}.", part)}, Presence::required, [&](FieldVisitor& at) {
    visit_length(at, {"girth_m", fmt::format("Around the {} as a tape measures it, m.", part)}, girth.girth);
    visit_length(at, {"height_m", "Height above the floor at which it is measured, m."}, girth.height);
  });
}

void visit_mannequin(FieldVisitor& fields, GarmentSpec& garment) {
  auto& [measures, cells_around] = garment.body.emplace<MannequinBody>();
  visit_girth(fields, "bust", measures.bust);
  visit_girth(fields, "waist", measures.waist);
  visit_girth(fields, "hip", measures.hip);
  visit_girth(fields, "thigh", measures.thigh);
  visit_girth(fields, "knee", measures.knee);
  visit_girth(fields, "ankle", measures.ankle);
  visit_length(fields, {"crotch_height_m", "Height of the crotch above the floor, m."},
               measures.crotch_height);
  fields.number({"hip_depth_over_width", "Depth of the hip over its width, without unit."},
                measures.hip_aspect, above(0, 10));
  fields.number({"thigh_gap_m", "Between the thighs at the thigh's height, m."}, measures.thigh_gap,
                from(0, largest_length_m));
  visit_length(fields, {"stance_m", "From one ankle's middle to the other's, m."}, measures.stance);
  fields.integer({"cells_around",
                  "Points around the torso, a multiple of four: 24 make 3,500 triangles, 96 make 45,000."},
                 cells_around, 16, 512);
}

void visit_body_file(FieldVisitor& fields, GarmentSpec& garment) {
  auto& [file, stance, close_holes_m] = garment.body.emplace<BodyFile>();
  fields.text({"file", "An .obj or .stl file; if not absolute, from the scene file's folder."},
              Presence::required, file);
  fields.number({"unit_m", "Metres in one unit of the file, m."}, stance.unit_m, above(0, 1e6));
  visit_choice(fields,
               {"up", "The file's axis along which the body stands upright; y where it is not given."},
               Presence::optional, up_axis_names, stance.up);
  visit_choice(fields,
               {"facing",
                "Where the body looks, along an axis of the file that is not the upright one; +z where it "
                "is not given."},
               Presence::optional, facing_names, stance.facing);
  std::optional<double> turn_deg;
  fields.optional_number({"turn_deg",
                          "By which the body is turned about y, from +z towards +x, when it stands upright "
                          "in y and looks to +z, degrees; 0 where it is not given."},
                         turn_deg, from(-360, 360));
  stance.turn_deg = turn_deg.value_or(0);
  fields.vector({"move_m",
                 "By which the body is moved then: [to its left, up, ahead], m. The legs are to be on either "
                 "side of x = 0, the feet on the floor."},
                Presence::optional, stance.move, from(-1e9, 1e9));
  fields.optional_number(
      {"close_holes_m",
       "Openings of the surface up to this size, m, are filled: twice the largest distance of their points "
       "from their middle. Without it the surface must have none."},
      close_holes_m, above(0, largest_length_m));
}

FileSurface body_from_file(const SceneSpec& spec, const BodyFile& body) {
  const std::string section = "/garment/surface_file";
  FileSurface read;
  Surface& surface = read.surface;
  try {
    read = read_surface(spec.file.parent_path() / body.file);
    require_joined(surface);
    surface = stood_up(std::move(surface), body.stance);
  } catch (const InputError& error) {
    refuse(spec.file, section + "/file", "is not a usable body: " + printable(error.what(), 1500));
  }
  if (body.close_holes_m) {
    try {
      close_openings(surface, *body.close_holes_m);
    } catch (const InputError& error) {
      refuse(spec.file, section + "/close_holes_m", "closes too little: " + printable(error.what(), 1500));
    }
  } else if (const std::vector<Opening> openings = openings_of(surface); !openings.empty()) {
    const Opening& largest = openings.front();
    refuse(
        spec.file, section + "/file",
        fmt::format("is not a closed body: it has {} opening{} of {} edges around {}, {} m across; close the "
                    "surface, or give \"close_holes_m\", the largest opening that mssim closes",
                    openings.size(), openings.size() == 1 ? "" : "s, the largest", largest.edges(),
                    place(largest.centre), shown(largest.size)));
  }
  return read;
}

/// A wrong unit shows here rather than in what a pattern makes of it.
void require_person(const SceneSpec& spec, const BodyFile& body, const BodyProfile& profile) {
  const double height = profile.highest() - profile.lowest();
  if (height >= shortest_person / 2 && height <= 1.5 * tallest_person) return;
  const auto guess = guess_unit(height / body.stance.unit_m);
  refuse(spec.file, "/garment/surface_file/unit_m",
         fmt::format("is {}, which makes the body {} m high: give the metres in one unit of the file{}",
                     shown_number(body.stance.unit_m), shown(height),
                     guess ? fmt::format(", {} where that is a person in {}",
                                         shown_number(guess->unit.metres), guess->unit.name)
                           : ""));
}

FileSurface body_of_garment(const SceneSpec& spec) {
  const GarmentSpec& garment = garment_of(spec);
  if (const auto* file = std::get_if<BodyFile>(&garment.body)) return body_from_file(spec, *file);
  const auto& form = std::get<MannequinBody>(garment.body);
  try {
    return {mannequin(form.measures, form.cells_around), {}};
  } catch (const InputError& error) {
    refuse(spec.file, "/garment/body", "is not a usable body: " + printable(error.what(), 1500));
  }
}

}  // namespace

void visit_body_fields(FieldVisitor& fields, GarmentSpec& garment) {
  const std::array bodies{
      Section{{"mannequin", "A dress form with legs, from measures. It stands on y = 0 and looks to +z."},
              [&](FieldVisitor& body) { visit_mannequin(body, garment); }},
      Section{{"surface_file",
               "A closed surface, with a leg on either side of x = 0 when it stands upright in y and looks "
               "to +z. mssim measure finds how a file has it."},
              [&](FieldVisitor& body) { visit_body_file(body, garment); }}};
  fields.one_of({"body", "Which of the sections says what the body is."}, bodies);
}

void check_body(const SceneSpec& spec) {
  const auto* body = std::get_if<BodyFile>(&garment_of(spec).body);
  if (body == nullptr || is_level(body->stance.facing, body->stance.up)) return;
  refuse(spec.file, "/garment/surface_file/facing",
         fmt::format("is \"{}\", the axis along which the body stands upright: give \"+x\", \"-x\" or the "
                     "other axis that is level",
                     facing_names.at(static_cast<std::size_t>(body->stance.facing))));
}

MeasuredBody measured_body(const SceneSpec& spec) {
  auto [surface, note] = body_of_garment(spec);
  try {
    BodyProfile profile(surface);
    const GarmentSpec& garment = garment_of(spec);
    if (const auto* file = std::get_if<BodyFile>(&garment.body); file && garment.jeans)
      require_person(spec, *file, profile);
    return {std::move(surface), std::move(note), std::move(profile)};
  } catch (const InputError& error) {
    refuse(spec.file, "/garment/body", "cannot be measured: " + printable(error.what(), 1500));
  }
}

}  // namespace mssim
