#include "garment/fitting/fit_bounds.h"

#include <array>
#include <cmath>
#include <sstream>
#include <string_view>

namespace mssim {
namespace {

/// What led to a number beyond its bound, as far as that can be told, and what may help. The keys are those
/// of scene files.
struct Diagnosis {
  std::string_view happened, remedy;
};

constexpr Diagnosis pierced{"the body comes through", "a larger skin_m or more nodes"};
constexpr Diagnosis stretched{"the cloth is stretched",
                              "a wider garment (hip_ease_m, waist_ease_m) or stiffer cloth"};

/// A row of the TABLE of a fit's numbers.
struct FitNumber {
  std::string_view name;
  double (*value)(const Fit& fit);
  double FitBounds::*bound;    ///< on the magnitude; null where there is none
  double per_unit;             ///< factor to the unit of `name`
  bool has_sign = false;       ///< the bound holds in both directions
  std::string_view what{};     ///< in a sentence
  std::string_view unit{};     ///< there, with what goes before it
  double per_spoken_unit = 1;  ///< factor to that
  Diagnosis too_large{};
  Diagnosis too_small{};                 ///< below its bound, where it has a sign
  bool (*exists)(const Fit&) = nullptr;  ///< null where every garment has the number
};

constexpr double mm = 1e3;
constexpr double percent = 100;

constexpr std::array<FitNumber, 15> numbers{{
    {"largest_gap_mm",
     [](const Fit& f) { return f.largest_gap; },
     &FitBounds::largest_gap,
     mm,
     false,
     "the largest gap of a seam",
     " mm",
     mm,
     {"a seam gapes", "a larger closing_share, or a wider garment (hip_ease_m, waist_ease_m)"}},
    {"nodes_inside", [](const Fit& f) { return static_cast<double>(f.nodes_inside); }, nullptr, 1},
    {"deepest_node_mm", [](const Fit& f) { return f.deepest_node; }, &FitBounds::deepest, mm, false,
     "the deepest node inside the body", " mm", mm, pierced},
    {"deepest_face_mm", [](const Fit& f) { return f.deepest_face_sample; }, &FitBounds::deepest, mm, false,
     "the deepest point of a face inside the body", " mm", mm, pierced},
    {"elongation_50", [](const Fit& f) { return f.elongation_50; }, nullptr, 1},
    {"elongation_99", [](const Fit& f) { return f.elongation_99; }, &FitBounds::elongation_99, 1, false,
     "the 99th percentile of elongations", " %", percent, stretched},
    {"elongation_999", [](const Fit& f) { return f.elongation_999; }, &FitBounds::elongation_999, 1, false,
     "the 99.9th percentile of elongations", " %", percent, stretched},
    {"elongation_max", [](const Fit& f) { return f.elongation_max; }, nullptr, 1},
    {"upper_edge_rise_mm",
     [](const Fit& f) { return f.upper_edge_rise; },
     &FitBounds::upper_edge_shift,
     mm,
     true,
     "the distance of the upper edge from its place in the pattern",
     " mm",
     mm,
     {"the garment was pushed up", "a higher waist (waist_height_m) or more waist_ease_m"},
     {"the garment slid down", "a lower waist (waist_height_m), less waist_ease_m or more friction"}},
    {"crotch_rise_mm",
     [](const Fit& f) { return f.meeting_rise.value(); },
     &FitBounds::meeting_shift,
     mm,
     true,
     "the distance of the crotch from its place in the pattern",
     " mm",
     mm,
     {"the crotch was drawn up", "more crotch_ease_m"},
     {"the crotch hangs low", "less crotch_ease_m, or a lower waist (waist_height_m)"},
     [](const Fit& f) { return f.meeting_rise.has_value(); }},
    {"rows", [](const Fit& f) { return static_cast<double>(f.rows); }, nullptr, 1},
    {"rows_astray",
     [](const Fit& f) { return static_cast<double>(f.rows_astray); },
     &FitBounds::rows_astray,
     1,
     false,
     "the number of rows that do not go once around their limb",
     "",
     1,
     {"the garment is not all around the body", "more nodes, or a body whose legs stand further apart"}},
    {"crossings",
     [](const Fit& f) { return static_cast<double>(f.crossings); },
     &FitBounds::crossings,
     1,
     false,
     "the number of places where layers of the cloth cross",
     "",
     1,
     {"layers went through each other",
      "layers that touch (\"layers\"), a larger thickness_m or more nodes"}},
    {"side_distance_mm",
     [](const Fit& f) { return f.side_distance.value(); },
     &FitBounds::side_distance,
     mm,
     false,
     "the largest distance of the side seams' cloth from the body between hip and thigh",
     " mm",
     mm,
     {"the garment stands off at the sides",
      "less hip_ease_m, a hip_height_m where the body is widest, or more nodes"},
     {},
     [](const Fit& f) { return f.side_distance.has_value(); }},
    {.name = "side_distance_height_m",
     .value = [](const Fit& f) { return f.side_distance_height.value(); },
     .bound = nullptr,
     .per_unit = 1,
     .exists = [](const Fit& f) { return f.side_distance_height.has_value(); }},
}};

bool exists(const FitNumber& number, const Fit& fit) {
  return number.exists == nullptr || number.exists(fit);
}

bool is_within(const FitNumber& number, const Fit& fit, const FitBounds& bounds) {
  // A number that is none keeps no bound.
  return std::abs(number.value(fit)) <= bounds.*number.bound;
}

/// The bound in units of which one has so many of the number's own.
std::string shown_bound(const FitNumber& number, const FitBounds& bounds, double per_unit) {
  std::ostringstream text;
  text << (number.has_sign ? "±" : "") << bounds.*number.bound * per_unit;
  return text.str();
}

const Diagnosis& diagnosis_of(const FitNumber& number, const Fit& fit) {
  return number.has_sign && number.value(fit) < 0 ? number.too_small : number.too_large;
}

}  // namespace

std::vector<FitCheck> fit_checks(const Fit& fit, const FitBounds& bounds) {
  std::vector<FitCheck> checks;
  for (const FitNumber& number : numbers) {
    if (!exists(number, fit)) continue;
    FitCheck& check = checks.emplace_back();
    check.name = number.name;
    check.value = number.per_unit * number.value(fit);
    if (number.bound == nullptr) continue;
    check.bound = number.per_unit * bounds.*number.bound;
    check.shown_bound = shown_bound(number, bounds, number.per_unit);
    check.within = is_within(number, fit, bounds);
  }
  return checks;
}

std::vector<std::string> misfits(const DressingResult& result, const Fit& fit, const FitBounds& bounds) {
  std::vector<std::string> found;
  if (!result.seamed_at)
    found.emplace_back(
        "the seams did not close in time; try a larger seam_force_n_per_m or longest_seaming_s, or a wider "
        "garment");
  if (!result.settled)
    found.emplace_back("the garment did not come to rest; try more viscous_damping_per_s or more nodes");
  for (const FitNumber& number : numbers) {
    if (number.bound == nullptr || !exists(number, fit) || is_within(number, fit, bounds)) continue;
    const Diagnosis& diagnosis = diagnosis_of(number, fit);
    std::ostringstream text;
    text << diagnosis.happened << ": " << number.what << " is " << number.value(fit) * number.per_spoken_unit
         << number.unit << ", beyond " << shown_bound(number, bounds, number.per_spoken_unit) << number.unit
         << "; try " << diagnosis.remedy;
    found.push_back(text.str());
  }
  return found;
}

}  // namespace mssim
