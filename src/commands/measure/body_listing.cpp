#include "commands/measure/body_listing.h"

#include <algorithm>
#include <cmath>

#include "garment/body/stance.h"
#include "geometry/geometry.h"

namespace mssim {
namespace {

/// A length for reading, m: to a tenth of a millimetre.
double to_tenths(double metres) { return std::round(1e4 * metres) / 1e4; }

Vec3d to_tenths(const Vec3d& point) {
  return {to_tenths(point.x) + 0.0, to_tenths(point.y) + 0.0, to_tenths(point.z) + 0.0};
}

std::string name_of_unit(double metres) {
  const auto units = length_units();
  const auto unit = std::ranges::find(units, metres, &LengthUnit::metres);
  return unit == units.end() ? "" : std::string(unit->name);
}

}  // namespace

void BodyListing::add(const std::string& measure, Cell value, const std::string& unit,
                      const std::string& note) {
  const auto text = [](const std::string& words) { return words.empty() ? Cell() : Cell(words); };
  rows_.add({{"measure", measure}, {"value", std::move(value)}, {"unit", text(unit)}, {"note", text(note)}});
}

void BodyListing::add_stance(const BodyStance& stance, const std::string& how) {
  const std::string name = name_of_unit(stance.unit_m);
  add("unit", stance.unit_m, "m", name.empty() ? how : name + ", " + how);
  add("up", up_axis_names.at(static_cast<std::size_t>(stance.up)), "", how);
  add("facing", facing_names.at(static_cast<std::size_t>(stance.facing)), "", how);
  if (stance.turn_deg != 0)
    add("turn", stance.turn_deg, "degrees", "about the upright axis, towards its left");
  if (!(stance.move == Vec3d{}))
    add("move", place(stance.move), "m",
        "to its left, up, ahead: legs on either side of x = 0, feet on the floor");
}

void BodyListing::add_openings(std::span<const Opening> openings, const std::string& what) {
  for (std::size_t i = 0; i < openings.size(); ++i)
    add("opening_" + std::to_string(i + 1), to_tenths(openings[i].size), "m",
        std::to_string(openings[i].edges()) + " edges around " + place(to_tenths(openings[i].centre)) + ", " +
            what);
}

void BodyListing::add_landmark(const std::string& name, const Landmark& landmark) {
  const std::string note = landmark.by_proportion ? "by proportion: nothing shows it" : "";
  add(name + "_height", to_tenths(landmark.height), "m", note);
  add(name + "_girth", landmark.girth ? Cell(to_tenths(*landmark.girth)) : Cell(), "m",
      landmark.girth ? "" : "the legs are not apart there");
}

void BodyListing::add_measures(const BodyProfile& profile, const BodyLandmarks& landmarks) {
  add("height", to_tenths(profile.highest() - profile.lowest()), "m");
  add_landmark("waist", landmarks.waist);
  add_landmark("hip", landmarks.hip);
  add("crotch_height", to_tenths(landmarks.crotch_height), "m");
  add_landmark("thigh", landmarks.thigh);
  add_landmark("knee", landmarks.knee);
  add_landmark("ankle", landmarks.ankle);
}

}  // namespace mssim
