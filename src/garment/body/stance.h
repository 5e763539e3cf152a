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

/// The axis of a file along which its body stands upright. The numbers index up_axis_names.
enum class UpAxis : std::uint32_t { y, z };
inline constexpr std::array<std::string_view, 2> up_axis_names{"y", "z"};

/// Where a body looks, along an axis of its file. The numbers index facing_names.
enum class Facing : std::uint32_t { plus_x, minus_x, plus_y, minus_y, plus_z, minus_z };
inline constexpr std::array<std::string_view, 6> facing_names{"+x", "-x", "+y", "-y", "+z", "-z"};

/// Unit vectors of a file's axes.
Vec3d direction_of(UpAxis up);
Vec3d direction_of(Facing facing);

/// Can a body that stands along `up` look there?
bool is_level(Facing facing, UpAxis up);

/// How a file has its body. Patterns need one in metres that stands upright in y, looks to +z and is about
/// its own mirror image in x.
struct BodyStance {
  double unit_m = 1;  ///< metres in one unit of the file
  UpAxis up = UpAxis::y;
  Facing facing = Facing::plus_z;  ///< is_level
  double turn_deg = 0;             ///< by which it is turned about y, from +z towards +x, when it stands so
  Vec3d move;                      ///< m, by which it is moved then
};

/// The body of a file as patterns need it.
Surface stood_up(Surface body, const BodyStance& stance);

/// What is known of how a file has its body.
struct GivenStance {
  std::optional<double> unit_m;
  std::optional<UpAxis> up;
  std::optional<Facing> facing;
};

/// How a file seems to have its body.
struct StanceGuess {
  BodyStance stance;
  /// One sentence for each part of it that is not certain, which begins with that part's name.
  std::vector<std::string> doubts;
};

/// Finds unit, upright axis and facing of a body, which need not be closed, and keeps what is given. The unit
/// is that in which it is a person's height. Its legs, which stand side by side below, tell the upright axis
/// and the sideways one, and its toes where it looks. Legs that stand askew have it turned in whole degrees.
/// It is moved so that the gap between its legs is at x = 0, its feet stand on y = 0 and its middle in depth
/// is z = 0, to a tenth of a millimetre. Throws InputError, which says what to give, for a body that is a
/// person in no unit, for one that lies, and for a facing that is given along the upright axis.
StanceGuess guess_stance(const Surface& body, const GivenStance& given);

}  // namespace mssim
