#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace mssim {

/// A unit that files of bodies are written in.
struct LengthUnit {
  std::string_view name;
  double metres = 1;
};

/// The TABLE of them.
std::span<const LengthUnit> length_units();

/// Their names, a comma after each.
std::string unit_names();

/// The heights of the people who are told apart by their unit, m.
inline constexpr double shortest_person = 1.2, tallest_person = 2.2;

/// A unit that makes a person of a body.
struct UnitGuess {
  LengthUnit unit;
  bool certain = false;  ///< the height is that of a person, and so it is in no other unit
};

/// The unit in which something of this height (in the file's unit) is a person. Where it is none in any, the
/// unit in which it comes nearest, if that is half to one and a half of one; none else.
std::optional<UnitGuess> guess_unit(double height);

}  // namespace mssim
