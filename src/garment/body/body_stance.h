#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "geometry/surface.h"

namespace mssim {

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

}  // namespace mssim
