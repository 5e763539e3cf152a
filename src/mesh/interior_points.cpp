#include "mesh/interior_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>

#include "geometry/geometry.h"
#include "text/error.h"

namespace mssim {
namespace {

/// Uniform numbers from the engine's own output: the standard fixes what std::mt19937 gives, and leaves open
/// what a std distribution makes of it.
class UniformNumbers {
 public:
  explicit UniformNumbers(std::uint32_t seed) : engine_(seed) {}
  /// Between -1 and 1, both excluded.
  double next() { return (static_cast<double>(engine_()) + 0.5) / 2147483648.0 - 1; }
  Vec3d next_vector() {
    const double x = next();
    const double y = next();
    return {x, y, next()};
  }

 private:
  std::mt19937 engine_;
};

/// Three perpendicular unit vectors in a random direction, all directions being equally likely: the rotation
/// of a random quaternion of length 1.
std::array<Vec3d, 3> random_axes(UniformNumbers& random) {
  double w = 0;
  Vec3d v;
  double squared = 0;
  do {
    w = random.next();
    v = random.next_vector();
    squared = w * w + dot(v, v);
  } while (squared > 1 || squared < 0.01);
  const double scale = 1 / std::sqrt(squared);
  const double a = w * scale;
  const auto [b, c, d] = scale * v;
  return {{{1 - 2 * (c * c + d * d), 2 * (b * c + a * d), 2 * (b * d - a * c)},
           {2 * (b * c - a * d), 1 - 2 * (b * b + d * d), 2 * (c * d + a * b)},
           {2 * (b * d + a * c), 2 * (c * d - a * b), 1 - 2 * (b * b + c * c)}}};
}

struct LatticePoint {
  double depth = 0;
  Vec3d position;
};

class Lattice {
 public:
  Lattice(const InteriorSpace& space, UniformNumbers& random)
      : space_(space), offset_(random.next_vector()), axes_(random_axes(random)) {}

  /// The points at this spacing that lie at least so deep.
  std::vector<LatticePoint> points(double spacing, double smallest_depth) const {
    const double cell = spacing * std::cbrt(2.0);  // a cubic cell holds two points
    const int reach = static_cast<int>(length(space_.half_size) / cell) + 2;
    std::vector<LatticePoint> found;
    for (int i = -reach; i <= reach; ++i)
      for (int j = -reach; j <= reach; ++j)
        for (int k = -reach; k <= reach; ++k)
          for (const double centre : {0.0, 0.5}) {
            const Vec3d at = 0.5 * offset_ + Vec3d{i + centre, j + centre, k + centre};
            const Vec3d position =
                (cell * at.x) * axes_[0] + (cell * at.y) * axes_[1] + (cell * at.z) * axes_[2];
            const double depth = space_.depth(position);
            if (depth > 0 && depth >= smallest_depth) found.push_back({depth, position});
          }
    return found;
  }

 private:
  const InteriorSpace& space_;
  Vec3d offset_;
  std::array<Vec3d, 3> axes_;
};

void require_between(double value, double low, double high, const std::string& what) {
  if (!(value >= low && value <= high))
    throw InputError("the " + what + " of interior points is " + decimal(value) + "; give a number from " +
                     decimal(low) + " to " + decimal(high));
}

}  // namespace

std::vector<Vec3d> place_interior_points(const InteriorPoints& parameters, const InteriorSpace& space) {
  constexpr std::uint32_t most = 1000000;
  if (parameters.count > most)
    throw InputError("the count of interior points is " + std::to_string(parameters.count) +
                     "; give at most " + std::to_string(most));
  require_between(parameters.jitter, 0, 0.5, "jitter");
  require_between(parameters.margin, 0, 1, "margin");
  if (parameters.count == 0) return {};

  UniformNumbers random(parameters.seed);
  const Lattice lattice(space, random);
  const auto points_at = [&](double spacing) { return lattice.points(spacing, parameters.margin * spacing); };

  // Where all the volume could be used, the spacing would be that of an endless lattice.
  const double endless = std::cbrt(space.volume / parameters.count);
  double enough = 0.25 * endless;
  double too_wide = 1.5 * endless;
  constexpr int halvings = 30;
  for (int i = 0; i < halvings; ++i) {
    const double spacing = (enough + too_wide) / 2;
    (points_at(spacing).size() >= parameters.count ? enough : too_wide) = spacing;
  }
  std::vector<LatticePoint> chosen = points_at(enough);
  if (chosen.size() < parameters.count)
    throw InputError(std::to_string(parameters.count) + " interior points do not fit into a volume of " +
                     shown(space.volume) + " m^3 at a margin of " + decimal(parameters.margin) +
                     " spacings from its surface; give fewer points or a smaller margin");
  // The few too many lie at the surface, where they are missed least.
  std::stable_sort(chosen.begin(), chosen.end(),
                   [](const LatticePoint& a, const LatticePoint& b) { return a.depth > b.depth; });
  chosen.resize(parameters.count);

  std::vector<Vec3d> points;
  for (const LatticePoint& point : chosen) {
    Vec3d moved = point.position;
    constexpr int tries = 20;
    for (int i = 0; i < tries; ++i) {
      const Vec3d candidate = point.position + (enough * parameters.jitter) * random.next_vector();
      if (space.depth(candidate) < parameters.margin * enough) continue;
      moved = candidate;
      break;
    }
    points.push_back(rounded(moved));
  }
  return points;
}

}  // namespace mssim
