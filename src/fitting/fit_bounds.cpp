#include "fitting/fit_bounds.h"

#include <array>
#include <cmath>
#include <sstream>
#include <string_view>

namespace mssim {
namespace {

/// A row of the TABLE of a fit's numbers.
struct FitNumber {
  std::string_view name;
  double (*value)(const Fit& fit);
  double FitBounds::*bound;  ///< on the magnitude; null where there is none
  double per_unit;           ///< factor to the unit of `name`
  std::string_view what;     ///< in a sentence
  std::string_view unit;     ///< there, with what goes before it
  double per_spoken_unit;    ///< factor to that
};

constexpr double mm = 1e3;
constexpr double percent = 100;

constexpr std::array<FitNumber, 13> numbers{{
    {"largest_gap_mm", [](const Fit& f) { return f.largest_gap; }, &FitBounds::largest_gap, mm,
     "the largest gap of a seam", " mm", mm},
    {"nodes_inside", [](const Fit& f) { return static_cast<double>(f.nodes_inside); }, nullptr, 1, "", "", 1},
    {"deepest_node_mm", [](const Fit& f) { return f.deepest_node; }, &FitBounds::deepest, mm,
     "the deepest node inside the body", " mm", mm},
    {"deepest_face_mm", [](const Fit& f) { return f.deepest_face_sample; }, &FitBounds::deepest, mm,
     "the deepest point of a face inside the body", " mm", mm},
    {"elongation_50", [](const Fit& f) { return f.elongation_50; }, nullptr, 1, "", "", 1},
    {"elongation_99", [](const Fit& f) { return f.elongation_99; }, &FitBounds::elongation_99, 1,
     "the elongation that 99 % stay below", " %", percent},
    {"elongation_999", [](const Fit& f) { return f.elongation_999; }, &FitBounds::elongation_999, 1,
     "the elongation that 99.9 % stay below", " %", percent},
    {"elongation_max", [](const Fit& f) { return f.elongation_max; }, nullptr, 1, "", "", 1},
    {"upper_edge_rise_mm", [](const Fit& f) { return f.upper_edge_rise; }, &FitBounds::upper_edge_shift, mm,
     "the upper edge's distance from where it is worn", " mm", mm},
    {"crotch_rise_mm", [](const Fit& f) { return f.meeting_rise; }, &FitBounds::meeting_shift, mm,
     "the distance of where seams meet from where that is worn", " mm", mm},
    {"rows", [](const Fit& f) { return static_cast<double>(f.rows); }, nullptr, 1, "", "", 1},
    {"rows_astray", [](const Fit& f) { return static_cast<double>(f.rows_astray); }, &FitBounds::rows_astray,
     1, "the number of rows that do not go once around their limb", "", 1},
    {"crossings", [](const Fit& f) { return static_cast<double>(f.crossings); }, &FitBounds::crossings, 1,
     "the number of places where layers of the cloth cross", "", 1},
}};

bool is_within(const FitNumber& number, const Fit& fit, const FitBounds& bounds) {
  // A number that is none keeps no bound.
  return std::abs(number.value(fit)) <= bounds.*number.bound;
}

}  // namespace

std::vector<FitCheck> fit_checks(const Fit& fit, const FitBounds& bounds) {
  std::vector<FitCheck> checks;
  for (const FitNumber& number : numbers) {
    FitCheck& check = checks.emplace_back();
    check.name = number.name;
    check.value = number.per_unit * number.value(fit);
    if (number.bound == nullptr) continue;
    check.bound = number.per_unit * bounds.*number.bound;
    check.within = is_within(number, fit, bounds);
  }
  return checks;
}

std::vector<std::string> misfits(const DressingResult& result, const Fit& fit, const FitBounds& bounds) {
  std::vector<std::string> found;
  if (!result.seamed_at) found.emplace_back("the seams did not close");
  if (!result.settled) found.emplace_back("the garment did not come to rest");
  for (const FitNumber& number : numbers) {
    if (number.bound == nullptr || is_within(number, fit, bounds)) continue;
    std::ostringstream text;
    text << number.what << " is " << number.value(fit) * number.per_spoken_unit << number.unit << ", beyond "
         << bounds.*number.bound * number.per_spoken_unit << number.unit;
    found.push_back(text.str());
  }
  return found;
}

}  // namespace mssim
