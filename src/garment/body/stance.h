#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/surface.h"

namespace mssim {

/// A unit of files of bodies.
struct LengthUnit {
  std::string_view name;
  double metres = 1;
};

/// The TABLE of units.
std::span<const LengthUnit> length_units();

/// The names of the units, each followed by a comma.
std::string unit_names();

/// The heights of people that guess_unit assumes, m.
inline constexpr double shortest_person = 1.2, tallest_person = 2.2;

/// A unit in which a body has a person's height.
struct UnitGuess {
  LengthUnit unit;
  bool certain = false;  ///< the height is a person's, and in no other unit
};

/// The unit in which this height (in the file's unit) is a person's. If there is none, the unit in which it
/// comes nearest, if it is off by a factor of at most 1.5; otherwise none.
std::optional<UnitGuess> guess_unit(double height);

/// The upright axis of the body in its file. The numbers index up_axis_names.
enum class UpAxis : std::uint32_t { y, z };
inline constexpr std::array<std::string_view, 2> up_axis_names{"y", "z"};

/// The direction in which a body looks, along an axis of its file. The numbers index facing_names.
enum class Facing : std::uint32_t { plus_x, minus_x, plus_y, minus_y, plus_z, minus_z };
inline constexpr std::array<std::string_view, 6> facing_names{"+x", "-x", "+y", "-y", "+z", "-z"};

/// Unit vectors of a file's axes.
Vec3d direction_of(UpAxis up);
Vec3d direction_of(Facing facing);

/// Whether a body that is upright along `up` can look in this direction.
bool is_level(Facing facing, UpAxis up);

/// Unit and orientation of a body in its file. Patterns need a body in metres that is upright in y, faces +z
/// and is about symmetric in x.
struct BodyStance {
  double unit_m = 1;  ///< metres in one unit of the file
  UpAxis up = UpAxis::y;
  Facing facing = Facing::plus_z;  ///< is_level
  double turn_deg = 0;             ///< rotation about y, from +z towards +x, after that
  Vec3d move;                      ///< m, translation after that
};

/// Transforms the body of a file as patterns need it.
Surface stood_up(Surface body, const BodyStance& stance);

/// The parts of a stance that the user gives.
struct GivenStance {
  std::optional<double> unit_m;
  std::optional<UpAxis> up;
  std::optional<Facing> facing;
};

/// The stance that guess_stance finds.
struct StanceGuess {
  BodyStance stance;
  /// A sentence for each uncertain part of the stance, which starts with that part's name.
  std::vector<std::string> doubts;
};

/// Finds unit, upright axis and facing of a body, which need not be closed, except those given. The unit is
/// the one in which it has a person's height. Its legs, side by side at the bottom, show the upright and the
/// sideways axis; its toes show the facing. If its legs are oblique to the axes, it is turned in whole
/// degrees. It is moved so that the gap between its legs is at x = 0, its feet are on y = 0 and its middle in
/// depth is z = 0, to 0.1 mm. Throws InputError with a remedy for a body that is no person in any unit, for
/// one that lies, and for a given facing along the upright axis.
StanceGuess guess_stance(const Surface& body, const GivenStance& given);

}  // namespace mssim
