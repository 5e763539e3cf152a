#pragma once

#include "garment/garment.h"
#include "garment/layers/cloth_cloth.h"
#include "garment/layers/cloth_contacts.h"
#include "geometry/vec3.h"
#include "tests/support/testing.h"

namespace mssim {

/// Panels with positions, velocities and masses, for tests of what layers do to each other.
struct LayeredCloth {
  Garment garment;
  std::array<std::vector<float>, 3> position, velocity;
  std::vector<float> mass;

  /// A panel whose node in a row and column lies where `place` says, at rest.
  void add(std::uint32_t layer, std::uint32_t rows, std::uint32_t columns,
           const std::function<Vec3d(double row, double column)>& place, float node_mass = 1) {
    const auto first = static_cast<std::uint32_t>(mass.size());
    garment.panels.push_back({"panel" + std::to_string(garment.panels.size()), rows, columns, first, layer});
    for (std::uint32_t row = 0; row < rows; ++row) {
      for (std::uint32_t column = 0; column < columns; ++column) {
        const auto point = vec3_cast<float>(place(row, column));
        for (std::size_t axis = 0; axis < 3; ++axis) {
          position[axis].push_back(std::array{point.x, point.y, point.z}[axis]);
          velocity[axis].push_back(0);
        }
        mass.push_back(node_mass);
      }
    }
  }
  static void set(std::array<std::vector<float>, 3>& of, std::size_t node, const Vec3<float>& value) {
    of[0][node] = value.x;
    of[1][node] = value.y;
    of[2][node] = value.z;
  }
  void set_node_velocity(std::uint32_t node, const Vec3<float>& speed) { set(velocity, node, speed); }

  Coordinates coordinates() const { return {position[0], position[1], position[2]}; }
  Vec3d point(std::uint32_t node) const { return vec3_cast<double>(point_of(coordinates(), node)); }
  Vec3d speed(std::uint32_t node) const {
    return vec3_cast<double>(point_of({velocity[0], velocity[1], velocity[2]}, node));
  }
  std::vector<Vec3d> points() const {
    std::vector<Vec3d> all;
    for (std::uint32_t node = 0; node < mass.size(); ++node) all.push_back(point(node));
    return all;
  }
  Vec3d momentum() const {
    Vec3d sum;
    for (std::uint32_t node = 0; node < mass.size(); ++node) sum += double{mass[node]} * speed(node);
    return sum;
  }
  /// A step of a collision of it.
  void collide(ClothClothCollision& collision, double dt) {
    collision.collide(
        dt,
        [&](std::size_t i) {
          const auto node = static_cast<std::uint32_t>(i);
          return NodeState{vec3_cast<float>(point(node)), vec3_cast<float>(speed(node))};
        },
        [&](std::size_t node, const NodeState& state) {
          set(position, node, state.position);
          set(velocity, node, state.velocity);
        });
  }
  ClothClothCollision collision(const ClothClothSettings& settings = {}, int threads = 1) const {
    return {garment, mass, settings, threads};
  }
};

/// How many nodes have gone through another layer, and not farther than `reach` (m).
inline std::size_t nodes_on_wrong_side(const LayeredCloth& cloth, double reach) {
  ClothContactSearch search(cloth.garment, reach, 1);
  return static_cast<std::size_t>(std::ranges::count_if(
      search.find(cloth.coordinates()), [](const ClothContact& contact) { return contact.gap < 0; }));
}

/// A horizontal sheet at a height: rows run towards -z, columns to +x, so that its normal points up.
inline std::function<Vec3d(double, double)> level(double height, double spacing, double x = 0, double z = 0) {
  return [=](double row, double column) { return Vec3d{x + spacing * column, height, z - spacing * row}; };
}

/// Sheets of random sizes, hills and folds that run through each other: cells of about 1 cm, folds of 3 cm.
inline LayeredCloth folded_sheets(std::mt19937& random, std::uint32_t inner_rows, std::uint32_t inner_columns,
                                  std::uint32_t outer_rows, std::uint32_t outer_columns) {
  LayeredCloth cloth;
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
  };
  const auto folded = [&](double height) {
    const Vec3d start{uniform(0, 0.01), height, uniform(0, 0.01)};
    const double turn = uniform(0, 1), tilt = uniform(0.05, 0.2);
    const double bumps = uniform(0.005, 0.02), roughness = uniform(0, 0.004);
    return [uniform, start, turn, tilt, bumps, roughness](double row, double column) {
      const Vec3d along = 0.01 * column * Vec3d{1, tilt, turn} + 0.01 * row * Vec3d{turn, -tilt, -1};
      const double wave = bumps * std::sin(0.9 * column + 0.3 * row) * std::cos(0.5 * row);
      const Vec3d noise{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
      return start + along + Vec3d{0.7 * wave, wave, 0} + roughness * noise;
    };
  };
  cloth.add(0, inner_rows, inner_columns, folded(0));
  cloth.add(1, outer_rows, outer_columns, folded(0.004));
  return cloth;
}

/// The crossings of all pairs of its layers.
inline std::size_t crossings(const LayeredCloth& cloth) {
  return count_crossings(cloth.garment, cloth.points());
}

}  // namespace mssim
