#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <type_traits>
#include <utility>

#include "geometry/geometry.h"
#include "geometry/triangle_tree.h"
#include "mesh/meshing.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

/// Throws InputError unless `metres` is between a tenth of a millimetre and a kilometre: coordinates are
/// rounded to micrometres. `what` names it in the message.
void require_length(double metres, std::string_view what) {
  if (!(metres >= 1e-4 && metres <= 1000))
    throw InputError("{} is {} m; give a length from 0.0001 to 1000 m", what, decimal(metres));
}

/// The corners of an icosahedron: (0, +-1, +-golden ratio) and its cyclic permutations.
std::array<Vec3d, 12> icosahedron_corners() {
  const double g = (1 + std::sqrt(5.0)) / 2;
  return {{{-1, g, 0},
           {1, g, 0},
           {-1, -g, 0},
           {1, -g, 0},
           {0, -1, g},
           {0, 1, g},
           {0, -1, -g},
           {0, 1, -g},
           {g, 0, -1},
           {g, 0, 1},
           {-g, 0, -1},
           {-g, 0, 1}}};
}

constexpr std::array<std::array<std::uint32_t, 3>, 20> icosahedron_faces{{
    {0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1},
}};

/// The key of a point of the cut icosahedron, which several faces may share: its weights at the corners
/// around it, as (corner of the icosahedron from 1, weight), ascending; corner 0: none.
using Weights = std::array<std::array<std::uint32_t, 2>, 3>;

void require_ring(const TorusShape& torus) {
  require_length(torus.major_radius_m, "a torus's major radius");
  require_length(torus.minor_radius_m, "a torus's minor radius");
  if (torus.cells_around % 2 != 0)
    throw InputError("a torus's cells around are " + std::to_string(torus.cells_around) +
                     ", an odd number; every other circle is turned by half a cell, so give an even one");
  if (torus.minor_radius_m >= torus.major_radius_m)
    throw InputError("a torus's minor radius of " + decimal(torus.minor_radius_m) +
                     " m leaves no hole in a ring of " + decimal(torus.major_radius_m) +
                     " m; give one less than the major radius");
}

/// Uniform numbers from the engine's own output: the standard fixes the output of std::mt19937, but not that
/// of the std distributions.
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

/// Three perpendicular unit vectors in a random direction, uniformly distributed: the rotation of a random
/// quaternion of length 1.
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

/// The space for interior points.
struct InteriorSpace {
  double volume = 0;  ///< m^3
  Vec3d half_size;    ///< m, of a box around the origin that holds the space
  /// Distance of a point inside from the surface, m; not positive outside.
  std::function<double(const Vec3d&)> depth;
};

struct LatticePoint {
  double depth = 0;
  Vec3d position;
};

class Lattice {
 public:
  Lattice(const InteriorSpace& space, UniformNumbers& random)
      : space_(space), offset_(random.next_vector()), axes_(random_axes(random)) {}

  /// The points at this spacing that are at least smallest_depth deep, m.
  std::vector<LatticePoint> points(double spacing, double smallest_depth) const {
    const double cell = spacing * std::cbrt(2.0);  // a cubic cell holds two points
    const int reach = static_cast<int>(length(space_.half_size) / cell) + 2;
    std::vector<LatticePoint> found;
    for (int i = -reach; i <= reach; ++i) {
      const auto [right, left] = lines_of_plane(i, reach, cell);
      for (int j = right; j <= left; ++j) {
        const auto [first, last] = cells_of_line(i, j, reach, cell);
        for (int k = first; k <= last; ++k)
          for (const double centre : {0.0, 0.5}) {
            const Vec3d at = 0.5 * offset_ + Vec3d{i + centre, j + centre, k + centre};
            const Vec3d position =
                (cell * at.x) * axes_[0] + (cell * at.y) * axes_[1] + (cell * at.z) * axes_[2];
            const double depth = space_.depth(position);
            if (depth > 0 && depth >= smallest_depth) found.push_back({depth, position});
          }
      }
    }
    return found;
  }

 private:
  /// The lines j of a plane of cells i, from -reach to reach, that may hold points of the box around the
  /// body. The last is less than the first if there are none.
  std::pair<int, int> lines_of_plane(int i, int reach, double cell) const {
    const auto corner = [&](unsigned number) {
      const auto side = [&](unsigned bit, double half_size) {
        return (number & bit) != 0 ? half_size + cell : -half_size - cell;
      };
      return Vec3d{side(1, space_.half_size.x), side(2, space_.half_size.y), side(4, space_.half_size.z)};
    };
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (unsigned number = 0; number < 8; ++number)
      for (const unsigned bit : {1U, 2U, 4U}) {
        if ((number & bit) != 0) continue;
        const Vec3d from = corner(number), to = corner(number | bit);
        const double height = cell * (0.5 * offset_.x + i);
        const double below = dot(from, axes_[0]) - height, above = dot(to, axes_[0]) - height;
        if ((below > 0) == (above > 0)) continue;
        const Vec3d cut = from + below / (below - above) * (to - from);
        const double line = dot(cut, axes_[1]) / cell - 0.5 * offset_.y;
        low = std::min(low, line);
        high = std::max(high, line);
      }
    if (high < low) return {0, -1};
    return {std::max(-reach, static_cast<int>(std::floor(low))),
            std::min(reach, static_cast<int>(std::ceil(high)))};
  }

  /// The cells k of a line of cells (i, j), from -reach to reach, that may hold points of the box around the
  /// body: all others of a slender body would be many more. The last is less than the first if there are
  /// none.
  std::pair<int, int> cells_of_line(int i, int j, int reach, double cell) const {
    const Vec3d begin = (cell * (0.5 * offset_.x + i)) * axes_[0] +
                        (cell * (0.5 * offset_.y + j)) * axes_[1] + (cell * 0.5 * offset_.z) * axes_[2];
    double low = -reach, high = reach;
    const auto cut = [&](double start, double step, double half_size) {
      const double within = half_size + cell;  // both points of a cell are within one cell of its corner
      if (std::abs(step) < 1e-9 * cell) {
        if (std::abs(start) > within) high = low - 1;
        return;
      }
      const double a = (-within - start) / step, b = (within - start) / step;
      low = std::max(low, std::min(a, b));
      high = std::min(high, std::max(a, b));
    };
    cut(begin.x, cell * axes_[2].x, space_.half_size.x);
    cut(begin.y, cell * axes_[2].y, space_.half_size.y);
    cut(begin.z, cell * axes_[2].z, space_.half_size.z);
    if (high < low) return {0, -1};
    return {static_cast<int>(std::floor(low)), static_cast<int>(std::ceil(high))};
  }

  const InteriorSpace& space_;
  Vec3d offset_;
  std::array<Vec3d, 3> axes_;
};

/// Exactly `count` points, rounded to micrometres. The spacing (the cube root of the volume per point) is the
/// largest at which `count` points of the lattice lie inside, at least the margin deep; it follows from
/// volume and count. Uses no libm except roots and no std distribution, so every platform places the same
/// points. Throws InputError for more points than fit.
std::vector<Vec3d> place_interior_points(const InteriorPoints& parameters, const InteriorSpace& space) {
  if (parameters.count == 0) return {};

  UniformNumbers random(parameters.seed);
  const Lattice lattice(space, random);
  const auto points_at = [&](double spacing) { return lattice.points(spacing, parameters.margin * spacing); };

  // The spacing of an infinite lattice, if all of the volume could be used.
  const double endless = std::cbrt(space.volume / parameters.count);
  const double enough = bisected({0.25 * endless, 1.5 * endless}, 30, [&](double spacing) {
                          return points_at(spacing).size() >= parameters.count;
                        }).holds;
  std::vector<LatticePoint> chosen = points_at(enough);
  if (chosen.size() < parameters.count)
    throw InputError(
        "{} interior points do not fit into a volume of {} m^3 at a margin of {} spacings from its surface; "
        "give fewer points or a smaller margin",
        parameters.count, shown(space.volume), decimal(parameters.margin));
  // The excess points are the least deep ones: they are missed least.
  std::ranges::stable_sort(chosen, std::greater(), &LatticePoint::depth);
  chosen.resize(parameters.count);

  std::vector<Vec3d> points;
  for (const LatticePoint& point : chosen) {
    Vec3d moved = point.position;
    constexpr int tries = 20;
    for (int i = 0; i < tries; ++i) {
      const Vec3d candidate = point.position + (enough * parameters.jitter) * random.next_vector();
      const double depth = space.depth(candidate);
      if (!(depth > 0 && depth >= parameters.margin * enough)) continue;
      moved = candidate;
      break;
    }
    points.push_back(rounded(moved));
  }
  return points;
}

/// Points of the surface.
std::uint64_t surface_point_count(const BoxShape& box) {
  const std::uint64_t a = box.cells[0], b = box.cells[1], c = box.cells[2];
  return 2 * (a * b + b * c + c * a) + 2;
}
std::uint64_t surface_point_count(const SphereShape& sphere) {
  return 10 * std::uint64_t{sphere.frequency} * sphere.frequency + 2;
}
std::uint64_t surface_point_count(const TorusShape& torus) {
  return std::uint64_t{torus.cells_around} * torus.cells_across;
}

/// Distance of a point from the surface, m; not positive outside.
double depth_in(const BoxShape& box, const Vec3d& point) {
  return std::min({box.size.x / 2 - std::abs(point.x), box.size.y / 2 - std::abs(point.y),
                   box.size.z / 2 - std::abs(point.z)});
}
double depth_in(const SphereShape& sphere, const Vec3d& point) { return sphere.radius_m - length(point); }
double depth_in(const TorusShape& torus, const Vec3d& point) {
  const double from_axis = std::sqrt(point.x * point.x + point.z * point.z);
  const double from_circle = from_axis - torus.major_radius_m;
  return torus.minor_radius_m - std::sqrt(from_circle * from_circle + point.y * point.y);
}

/// Of a box around the origin that holds the shape, m.
Vec3d half_size(const BoxShape& box) { return 0.5 * box.size; }
Vec3d half_size(const SphereShape& sphere) { return {sphere.radius_m, sphere.radius_m, sphere.radius_m}; }
Vec3d half_size(const TorusShape& torus) {
  const double outer = torus.major_radius_m + torus.minor_radius_m;
  return {outer, torus.minor_radius_m, outer};
}

/// Lengths of a surface's edges, m.
struct EdgeLengths {
  double shortest = HUGE_VAL, longest = 0;

  explicit EdgeLengths(const Surface& surface) {
    for (const auto& triangle : surface.triangles)
      for (std::size_t i = 0; i < 3; ++i) {
        const double edge = length(surface.points[triangle[i]] - surface.points[triangle[(i + 1) % 3]]);
        shortest = std::min(shortest, edge);
        longest = std::max(longest, edge);
      }
  }
};

/// Throws InputError if points are this near to each other, m: rounding would merge them or turn triangles
/// over.
void require_apart(double distance) {
  constexpr double least = 1e-5;
  if (distance >= least) return;
  throw InputError(
      "its points are {} m apart, and coordinates are rounded to 0.000001 m; give a larger body, or fewer "
      "cells or points, for a distance of {} m",
      two_digits(distance), decimal(least));
}

}  // namespace

Surface surface_of(const BoxShape& box) {
  require_length(box.size.x, "a box's size along x");
  require_length(box.size.y, "a box's size along y");
  require_length(box.size.z, "a box's size along z");
  Surface surface;
  using Corner = std::array<std::uint32_t, 3>;  // of the grid of cells
  PointNumbers<Corner> points(surface);
  const auto coordinate = [&](const Corner& at, std::size_t axis, double size) {
    return size * (at[axis] / static_cast<double>(box.cells[axis]) - 0.5);
  };
  for (std::size_t normal = 0; normal < 3; ++normal) {
    const std::size_t right = (normal + 1) % 3;
    const std::size_t up = (normal + 2) % 3;
    for (const bool far_side : {false, true})
      for (std::uint32_t r = 0; r < box.cells[right]; ++r)
        for (std::uint32_t u = 0; u < box.cells[up]; ++u) {
          const auto corner = [&](std::uint32_t to_right, std::uint32_t to_up) {
            Corner at{};
            at[normal] = far_side ? box.cells[normal] : 0;
            at[right] = r + to_right;
            at[up] = u + to_up;
            return points.of(at, [&] {
              return rounded({coordinate(at, 0, box.size.x), coordinate(at, 1, box.size.y),
                              coordinate(at, 2, box.size.z)});
            });
          };
          // (right, up, normal) is right-handed: counter-clockwise seen from the far side.
          std::array<std::uint32_t, 4> square{corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)};
          if (!far_side) std::swap(square[1], square[3]);
          surface.triangles.push_back({square[0], square[1], square[2]});
          surface.triangles.push_back({square[0], square[2], square[3]});
        }
  }
  return surface;
}

Surface surface_of(const SphereShape& sphere) {
  require_length(sphere.radius_m, "a sphere's radius");
  Surface surface;
  PointNumbers<Weights> points(surface);
  const std::array<Vec3d, 12> corners = icosahedron_corners();
  const auto position = [&](const Weights& weights) {
    Vec3d sum{};
    for (const auto& [corner, weight] : weights)
      if (corner > 0) sum += static_cast<double>(weight) * corners[corner - 1];
    return rounded((sphere.radius_m / length(sum)) * sum);
  };
  const std::uint32_t n = sphere.frequency;
  for (const auto& face : icosahedron_faces)
    for (std::uint32_t i = 0; i < n; ++i)
      for (std::uint32_t j = 0; i + j < n; ++j) {
        const auto corner = [&](std::uint32_t second, std::uint32_t third) {
          const std::array<std::uint32_t, 3> weights{n - second - third, second, third};
          Weights key{};
          for (std::size_t k = 0; k < 3; ++k)
            if (weights[k] > 0) key[k] = {face[k] + 1, weights[k]};
          std::ranges::sort(key);
          return points.of(key, [&] { return position(key); });
        };
        surface.triangles.push_back({corner(i, j), corner(i + 1, j), corner(i, j + 1)});
        if (i + j + 1 < n)
          surface.triangles.push_back({corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)});
      }
  return surface;
}

Surface surface_of(const TorusShape& torus) {
  require_ring(torus);
  constexpr double full_turn = 2 * std::numbers::pi;
  const std::uint32_t around = torus.cells_around;
  const std::uint32_t across = torus.cells_across;
  Surface surface;
  for (std::uint32_t i = 0; i < around; ++i)
    for (std::uint32_t j = 0; j < across; ++j) {
      const double u = full_turn * i / around;
      const double v = full_turn * (j + (i % 2 == 0 ? 0.0 : 0.5)) / across;
      const double ring = torus.major_radius_m + torus.minor_radius_m * std::cos(v);
      surface.points.push_back(
          rounded({ring * std::cos(u), torus.minor_radius_m * std::sin(v), ring * std::sin(u)}));
    }

  for (std::uint32_t i = 0; i < around; ++i)
    for (std::uint32_t j = 0; j < across; ++j) {
      const auto point = [&](std::uint32_t circle, std::uint32_t place_on_it) {
        return (circle % around) * across + place_on_it % across;
      };
      // Point j of an odd circle lies between points j and j + 1 of the neighbouring even circles.
      const std::uint32_t a = point(i, j);
      const std::uint32_t b = point(i, j + 1);
      if (i % 2 == 0) {
        surface.triangles.push_back({a, b, point(i + 1, j)});
        surface.triangles.push_back({b, point(i + 1, j + 1), point(i + 1, j)});
      } else {
        surface.triangles.push_back({a, point(i + 1, j + 1), point(i + 1, j)});
        surface.triangles.push_back({a, b, point(i + 1, j + 1)});
      }
    }
  return surface;
}

std::uint64_t point_count(const GeneratedShape& shape) {
  return std::visit([](const auto& kind) { return surface_point_count(kind); }, shape.solid) +
         shape.interior.count;
}

ShapePoints points_of(const GeneratedShape& shape) {
  const InteriorPoints& interior = shape.interior;
  return std::visit(
      [&](const auto& kind) {
        ShapePoints points;
        points.surface = surface_of(kind);
        const double volume = volume_of(points.surface);
        const EdgeLengths edges(points.surface);
        require_apart(edges.shortest);
        if (interior.count > 0) require_apart(std::cbrt(volume / interior.count));
        // A round shape has points outside its triangles, no deeper than a triangle's middle, whose nearest
        // corner lies on the shape.
        const TriangleTree triangles(points.surface);
        constexpr bool is_round = !std::is_same_v<decltype(kind), const BoxShape&>;
        const double deepest_triangle = is_round ? edges.longest / std::sqrt(3.0) : 0;
        const auto depth = [&](const Vec3d& point) {
          const double in_shape = depth_in(kind, point);
          if (in_shape <= 0 || in_shape > deepest_triangle) return in_shape;
          const Vec3d placed = rounded(point);
          const std::optional<int> winding = triangles.winding_by_ray(placed);
          return (winding ? *winding : triangles.winding_by_angles(placed)) == 1 ? in_shape : 0;
        };
        points.interior = place_interior_points(interior, {volume, half_size(kind), depth});
        return points;
      },
      shape.solid);
}

}  // namespace mssim
