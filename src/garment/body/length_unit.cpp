#include "garment/body/length_unit.h"

#include <algorithm>
#include <array>

namespace mssim {
namespace {

constexpr std::array<LengthUnit, 6> table{
    {{"m", 1}, {"dm", 0.1}, {"cm", 0.01}, {"mm", 0.001}, {"inch", 0.0254}, {"foot", 0.3048}}};

/// How many times too small or too large a person of this height, m, would be; 1 for a person.
double misfit(double height) { return std::max({1.0, shortest_person / height, height / tallest_person}); }

}  // namespace

std::span<const LengthUnit> length_units() { return table; }

std::string unit_names() {
  std::string names;
  for (const LengthUnit& unit : table) names += std::string(unit.name) + ", ";
  return names;
}

std::optional<UnitGuess> guess_unit(double height) {
  constexpr double largest_misfit = 1.5;
  const auto misfit_in = [&](const LengthUnit& unit) { return misfit(height * unit.metres); };
  const LengthUnit& best = *std::ranges::min_element(table, {}, misfit_in);
  if (!(height > 0) || misfit_in(best) > largest_misfit) return std::nullopt;
  return UnitGuess{best, misfit_in(best) == 1};
}

}  // namespace mssim
