#pragma once

#include <cmath>
#include <cstdint>

#include "model/system.h"

namespace mssim {

/// `free` nodes in a row along x between two that are pinned, joined by springs at rest of stiffness 200 N/m,
/// 1 cm long, without gravity and damping. A node weighs 2e-5 kg.
inline System spring_chain(std::uint32_t free) {
  System system;
  const std::uint32_t nodes = free + 2;
  for (std::uint32_t node = 0; node < nodes; ++node) system.start.position.push_back({0.01 * node, 1, 0});
  system.start.velocity.assign(nodes, {});
  for (std::uint32_t node = 0; node + 1 < nodes; ++node) system.springs.push_back({node, node + 1, 0.01F, 0});
  system.topology = TetrahedralMesh{};
  system.materials = {{200, 0}};
  system.node_mass.assign(nodes, 2e-5);
  system.pins = {0, nodes - 1};
  return system;
}

/// The same with one free node, which starts off its place along x: an oscillator.
inline System spring_oscillator(double offset_m = 1e-4) {
  System system = spring_chain(1);
  system.start.position[1].x += offset_m;
  return system;
}

/// Its angular frequency, 1/s: two springs pull at the node.
inline double oscillator_frequency(const System& system) {
  return std::sqrt(2 * system.materials[0].stiffness / system.node_mass[1]);
}

/// An oscillator that hardly moves, as stiff modes of scenes do, and beside it one a hundredth as fast that
/// has almost all of the energy. oscillator_frequency() is that of the first.
inline System fast_and_slow_oscillator() {
  System system = spring_oscillator(1e-7);
  for (const Vec3d& x : {Vec3d{0, 2, 0}, Vec3d{0.011, 2, 0}, Vec3d{0.02, 2, 0}})
    system.start.position.push_back(x);
  system.start.velocity.resize(6);
  system.springs.push_back({3, 4, 0.01F, 0});
  system.springs.push_back({4, 5, 0.01F, 0});
  system.node_mass.resize(6, 2e-1);
  system.pins = {0, 2, 3, 5};
  return system;
}

}  // namespace mssim
