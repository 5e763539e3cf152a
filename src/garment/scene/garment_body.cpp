#include <array>
#include <utility>
#include <vector>

#include "garment/body/stance.h"
#include "garment/scene/garment_fields.h"
#include "garment/scene/garment_scene.h"
#include "geometry/geometry.h"
#include "geometry/surface.h"
#include "mesh/surface_file.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

void visit_girth(FieldVisitor& fields, std::string_view part, GirthAt& girth) {
  fields.object({part, fmt::format("Girth of the {}.", part)}, Presence::required, [&](FieldVisitor& at) {
    visit_length(at, {"girth_m", fmt::format("Girth of the {} as a tape measures it, m.", part)},
                 girth.girth);
    visit_length(at, {"height_m", "Height above the floor at which the girth is measured, m."}, girth.height);
  });
}

void visit_mannequin(FieldVisitor& fields, GarmentSpec& garment) {
  auto& [measures, cells_around] = garment.body.emplace<MannequinBody>();
  for (const auto& [name, girth] : body_girths) visit_girth(fields, name, measures.*girth);
  visit_length(fields, {"crotch_height_m", "Height of the crotch above the floor, m."},
               measures.crotch_height);
  fields.number({"hip_depth_over_width", "Depth of the hip over its width, without unit."},
                measures.hip_aspect, above(0, 10));
  fields.number({"thigh_gap_m", "Gap between the thighs at the thigh's height, m."}, measures.thigh_gap,
                from(0, largest_length_m));
  visit_length(fields, {"stance_m", "Distance between the middles of the ankles, m."}, measures.stance);
  fields.integer({"cells_around",
                  "Points around the torso, a multiple of four: 24 make 3,500 triangles, 96 make 45,000."},
                 cells_around, 16, 512);
}

void visit_body_file(FieldVisitor& fields, GarmentSpec& garment) {
  auto& [file, stance, close_holes_m] = garment.body.emplace<BodyFile>();
  fields.text({"file", "An .obj or .stl file; a relative path starts at the scene file's folder."},
              Presence::required, file);
  fields.number({"unit_m", "Metres in one unit of the file, m."}, stance.unit_m, above(0, 1e6));
  visit_choice(fields, {"up", "The file's axis along which the body stands upright; y by default."},
               Presence::optional, up_axis_names, stance.up);
  visit_choice(fields,
               {"facing",
                "Direction in which the body looks, along an axis of the file that is not the upright one; "
                "+z by default."},
               Presence::optional, facing_names, stance.facing);
  std::optional<double> turn_deg;
  fields.optional_number({"turn_deg",
                          "Rotation of the body about y, from +z towards +x, after it is upright in y and "
                          "faces +z, degrees; 0 by default."},
                         turn_deg, from(-360, 360));
  stance.turn_deg = turn_deg.value_or(0);
  fields.vector({"move_m",
                 "Translation of the body after that: [to its left, up, ahead], m. It must put one leg on "
                 "each side of x = 0 and the feet on the floor."},
                Presence::optional, stance.move, from(-1e9, 1e9));
  fields.optional_number(
      {"close_holes_m",
       "Largest size of openings of the surface that are closed, m: the largest distance between two of "
       "their points (a bound for more than 3,000). Without this field, the surface must be closed."},
      close_holes_m, above(0, largest_length_m));
}

FileSurface body_from_file(const SceneSpec& spec, const BodyFile& body) {
  const std::string section = "/garment/surface_file";
  FileSurface read = refusing<InputError>(spec.file, section + "/file", "is not a usable body", [&] {
    FileSurface found = read_surface(spec.file.parent_path() / body.file);
    require_joined(found.surface);
    found.surface = stood_up(std::move(found.surface), body.stance);
    return found;
  });
  Surface& surface = read.surface;
  if (body.close_holes_m) {
    refusing<InputError>(spec.file, section + "/close_holes_m", "closes too little",
                         [&] { close_openings(surface, *body.close_holes_m); });
  } else if (const std::vector<Opening> openings = openings_of(surface); !openings.empty()) {
    const Opening& largest = openings.front();
    refuse(
        spec.file, section + "/file",
        fmt::format("is not a closed body: it has {} opening{} of {} edges around {}, {} m across; close the "
                    "surface, or give \"close_holes_m\", the size of the largest opening to close",
                    openings.size(), openings.size() == 1 ? "" : "s, the largest", largest.edges(),
                    place(largest.centre), shown(largest.size)));
  }
  return read;
}

/// Reports a wrong unit here, before a pattern fails for it.
void require_person(const SceneSpec& spec, const BodyFile& body, const BodyProfile& profile) {
  const double height = profile.highest() - profile.lowest();
  if (height >= shortest_person / 2 && height <= 1.5 * tallest_person) return;
  const auto guess = guess_unit(height / body.stance.unit_m);
  refuse(spec.file, "/garment/surface_file/unit_m",
         fmt::format("is {}, which makes the body {} m high: give the metres in one unit of the file{}",
                     shown_number(body.stance.unit_m), shown(height),
                     guess ? fmt::format(", {} if the body is a person in {}",
                                         shown_number(guess->unit.metres), guess->unit.name)
                           : ""));
}

FileSurface body_of_garment(const SceneSpec& spec) {
  const GarmentSpec& garment = garment_of(spec);
  if (const auto* file = std::get_if<BodyFile>(&garment.body)) return body_from_file(spec, *file);
  const auto& form = std::get<MannequinBody>(garment.body);
  return {refusing<InputError>(spec.file, "/garment/body", "is not a usable body",
                               [&] { return mannequin(form.measures, form.cells_around); }),
          {}};
}

}  // namespace

void visit_body_fields(FieldVisitor& fields, GarmentSpec& garment) {
  const std::array bodies{
      Section{{"mannequin", "A dress form with legs, from measures. It stands on y = 0 and faces +z."},
              [&](FieldVisitor& body) { visit_mannequin(body, garment); }},
      Section{{"surface_file",
               "A closed surface, with one leg on each side of x = 0 when it is upright in y and faces +z. "
               "mssim measure finds the values for a file."},
              [&](FieldVisitor& body) { visit_body_file(body, garment); }}};
  fields.one_of({"body", "Section that describes the body."}, bodies);
}

void check_body(const SceneSpec& spec) {
  const auto* body = std::get_if<BodyFile>(&garment_of(spec).body);
  if (body == nullptr || is_level(body->stance.facing, body->stance.up)) return;
  refuse(spec.file, "/garment/surface_file/facing",
         fmt::format("is \"{}\", the axis along which the body stands upright: give \"+x\", \"-x\" or the "
                     "other horizontal axis",
                     facing_names.at(static_cast<std::size_t>(body->stance.facing))));
}

MeasuredBody measured_body(const SceneSpec& spec) {
  FileSurface read = body_of_garment(spec);
  auto profile = refusing<InputError>(spec.file, "/garment/body", "cannot be measured",
                                      [&] { return BodyProfile(read.surface); });
  const GarmentSpec& garment = garment_of(spec);
  if (const auto* file = std::get_if<BodyFile>(&garment.body); file && garment.jeans)
    require_person(spec, *file, profile);
  return {std::move(read.surface), std::move(read.note), std::move(profile)};
}

}  // namespace mssim
