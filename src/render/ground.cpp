#include "render/ground.h"

#include <algorithm>
#include <cmath>

namespace mssim {
namespace {

/// The largest of 1, 2 and 5 times a power of ten up to `length`.
double round_length(double length) {
  const double power = std::pow(10, std::floor(std::log10(length)));
  for (const double factor : {5.0, 2.0})
    if (factor * power <= length) return factor * power;
  return power;
}

/// How much of the stretch `width` around `at`, a distance from a line, the line covers.
double covered(double at, double width, double line) {
  const double low = std::max(at - width / 2, -line / 2), high = std::min(at + width / 2, line / 2);
  return std::max(high - low, 0.0) / width;
}

constexpr double lines_across = 8;   // what stands on the ground
constexpr double line_pixels = 1.2;  // width of a line
constexpr float line_darkness = 0.22F, shadow_darkness = 0.45F;

}  // namespace

Ground::Ground(const Box<double>& box, double height) : height_(height), middle_(box.middle()) {
  const Vec3d size = box.size();
  const double across = std::max({size.x, size.z, 0.25 * size.y, 1e-6});
  spacing_ = round_length(across / lines_across);
  radius_ = 0.75 * std::hypot(across, across);
}

std::optional<Vec3d> Ground::met_by(const Camera& camera, double x, double y) const {
  constexpr double least_slope = 0.01;
  if (camera.near().y < least_slope) return std::nullopt;
  const double z = (height_ - y * camera.up().y) / camera.near().y;  // the camera's right is level
  return x * camera.right() + y * camera.up() + z * camera.near();
}

Light Ground::colour_at(const Vec3d& point, const Light& background, float light, const Camera& camera,
                        double pixel) const {
  const double far = std::hypot(point.x - middle_.x, point.z - middle_.z) / radius_;
  const auto fade = static_cast<float>(std::clamp(2 - far, 0.0, 1.0));  // 1 near by, 0 from two radii on
  if (fade == 0) return background;
  // How far a pixel reaches on the ground: it is stretched where the camera looks along it.
  const Vec3d down = camera.up() - (camera.up().y / camera.near().y) * camera.near();
  const auto line_at = [&](double at, double right, double up) {
    return covered(at - spacing_ * std::round(at / spacing_), pixel * (std::abs(right) + std::abs(up)),
                   line_pixels * pixel);
  };
  const double lines =
      std::max(line_at(point.x, camera.right().x, down.x), line_at(point.z, camera.right().z, down.z));
  const float darkness = std::max(line_darkness * static_cast<float>(lines), shadow_darkness * (1 - light));
  return (1 - fade * darkness) * background;
}

}  // namespace mssim
