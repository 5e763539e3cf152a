#include "garment/body_stance.h"

#include <cstddef>

namespace mssim {
namespace {

constexpr std::array<Vec3d, 3> axes{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

}  // namespace

Vec3d direction_of(UpAxis up) { return up == UpAxis::y ? axes[1] : axes[2]; }

Vec3d direction_of(Facing facing) {
  const auto number = static_cast<std::size_t>(facing);
  return (number % 2 == 0 ? 1.0 : -1.0) * axes.at(number / 2);
}

bool is_level(Facing facing, UpAxis up) { return dot(direction_of(facing), direction_of(up)) == 0; }

Surface stood_up(Surface body, const BodyStance& stance) {
  const Vec3d up = direction_of(stance.up), ahead = direction_of(stance.facing), left = cross(up, ahead);
  for (Vec3d& point : body.points)
    point = stance.unit_m * Vec3d{dot(point, left), dot(point, up), dot(point, ahead)} + stance.move;
  return body;
}

}  // namespace mssim
