#pragma once

#include <cstdint>

#include "model/system.h"
#include "scene/scene_kinds.h"
#include "scene/spec/scene_spec.h"

namespace mssim {

/// A small cloth of the committed scenes' material, high above the floor, for tests to change.
inline SceneSpec cloth_spec(std::uint32_t rows, std::uint32_t columns) {
  ClothSpec cloth;
  cloth.rows = rows;
  cloth.columns = columns;
  cloth.spacing_m = 0.01;
  cloth.areal_density_kg_per_m2 = 0.2;
  cloth.ceiling_height_m = 1;
  cloth.pins = ClothPins{0, 10};
  cloth.ripple = {0.0005, 0.2, 0.2};
  cloth.springs = {{{200, 0.01}, {60, 0.003}, {8, 0.0004}}};
  SceneSpec spec;
  spec.name = "test";
  spec.dt_s = 1e-4;
  spec.gravity_m_per_s2 = 9.81;
  spec.viscous_damping_per_s = 0.1;
  spec.floor = {0, 0.3, 0.4};
  spec.content = cloth;
  return spec;
}

inline System cloth_system(std::uint32_t rows, std::uint32_t columns) {
  return build_system(cloth_spec(rows, columns));
}

/// A flat sheet at rest, without pins, at `height_m`.
inline SceneSpec sheet_spec(std::uint32_t rows, std::uint32_t columns, double height_m) {
  SceneSpec spec = cloth_spec(rows, columns);
  auto& cloth = std::get<ClothSpec>(spec.content);
  cloth.pins.reset();
  cloth.ripple = {0, 1, 0};
  cloth.ceiling_height_m = height_m;
  return spec;
}

/// A rippled cloth without pins, gravity, damping by the air: nothing outside the cloth acts on it.
inline System lone_cloth(std::uint32_t rows, std::uint32_t columns) {
  SceneSpec spec = cloth_spec(rows, columns);
  std::get<ClothSpec>(spec.content).pins.reset();
  spec.gravity_m_per_s2 = 0;
  spec.viscous_damping_per_s = 0;
  return build_system(spec);
}

/// The same without any damping.
inline System undamped(System system) {
  for (SpringMaterial& material : system.materials) material.damping = 0;
  system.viscous_damping = 0;
  return system;
}

/// Whether a node lies on the floor or rises from it.
inline bool has_met_floor(const System& system, const State& state) {
  for (std::size_t node = 0; node < system.nodes(); ++node)
    if (state.velocity[node].y > 0 || state.position[node].y == system.floor.height) return true;
  return false;
}

}  // namespace mssim
