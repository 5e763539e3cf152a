#include "garment/body/body_stance.h"

#include <cmath>
#include <cstddef>
#include <numbers>

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
  // Without a turn these are 1 and 0, which change no bit.
  const double turn = stance.turn_deg * std::numbers::pi / 180, cosine = std::cos(turn),
               sine = std::sin(turn);
  for (Vec3d& point : body.points) {
    const double x = dot(point, left), z = dot(point, ahead);
    const Vec3d turned{cosine * x + sine * z, dot(point, up), cosine * z - sine * x};
    point = stance.unit_m * turned + stance.move;
  }
  return body;
}

}  // namespace mssim
