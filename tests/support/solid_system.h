#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <utility>

#include "bench/verification/second_stretch.h"
#include "model/system.h"

namespace mssim {

/// A block of nx x ny x nz nodes about 2 cm apart, each cube of neighbours cut into six tetrahedra around its
/// diagonal (Kuhn's cut), its inner nodes off their places at random: a tetrahedral body that needs no
/// mesher. It starts strained and moving, `height_m` above the floor.
inline System solid_block(std::uint32_t nx, std::uint32_t ny, std::uint32_t nz, double height_m = 0.5) {
  constexpr double spacing = 0.02;
  System system;
  std::mt19937 random(nx + 100 * ny + 10000 * nz);
  const auto jitter = [&] { return (static_cast<double>(random()) / 4294967296.0 - 0.5) * 0.4 * spacing; };
  SolidBlock block;
  add_block(block, nx, ny, nz, spacing, {0, height_m, 0});
  for (const Vec3d& x : block.position) {
    const double right = jitter(), up = std::abs(jitter()), ahead = jitter();
    system.start.position.push_back(x + Vec3d{right, up, ahead});
  }
  system.topology = TetrahedralMesh{std::move(block.tetrahedra)};
  for (const auto& [first, second] : block.edges) {
    const Vec3d d = system.start.position[second] - system.start.position[first];
    system.springs.push_back({first, second, static_cast<float>(std::sqrt(dot(d, d))), 0});
  }
  system.materials = {{200, 0.05}};
  system.node_mass.assign(system.nodes(), 0.004);
  system.gravity = 9.81;
  system.viscous_damping = 0.1;
  system.floor = {0, 0.5, 0.3};
  for (Vec3d& x : system.start.position) {
    system.start.velocity.push_back({0.3 * x.z + 0.1, 0.5 * x.x - 0.2, 0.4 * x.y - 0.1});
    x += {0.001 * std::sin(90 * x.y), 0.001 * std::sin(70 * x.z), 0.001 * std::sin(80 * x.x)};
  }
  round_to_single(system.start);
  return system;
}

/// Appends a body to the bodies of a system, `offset` away from where it stands, with materials of its own.
inline void append_body(System& system, const System& body, const Vec3d& offset) {
  const auto nodes = static_cast<std::uint32_t>(system.nodes());
  const auto kinds = static_cast<std::uint32_t>(system.materials.size());
  for (const Vec3d& x : body.start.position) system.start.position.push_back(x + offset);
  for (const Vec3d& v : body.start.velocity) system.start.velocity.push_back(v);
  for (Spring spring : body.springs) {
    spring.first += nodes;
    spring.second += nodes;
    spring.kind += kinds;
    system.springs.push_back(spring);
  }
  auto& tetrahedra = std::get<TetrahedralMesh>(system.topology).tetrahedra;
  for (Tetrahedron corners : std::get<TetrahedralMesh>(body.topology).tetrahedra) {
    for (std::uint32_t& corner : corners) corner += nodes;
    tetrahedra.push_back(corners);
  }
  for (const SpringMaterial& material : body.materials) system.materials.push_back(material);
  for (const double mass : body.node_mass) system.node_mass.push_back(mass);
  for (const std::uint32_t pin : body.pins) system.pins.push_back(nodes + pin);
  round_to_single(system.start);
}

/// Two blocks beside each other in one system, of unlike nodes and materials.
inline System two_solid_blocks() {
  System system = solid_block(4, 5, 3), other = solid_block(3, 3, 7);
  other.materials = {{350, 0.02}};
  other.node_mass.assign(other.nodes(), 0.007);
  append_body(system, other, {0.5, 0.1, 0});
  return system;
}

/// `count` bodies like this one in one system, each in its own place and with velocities of its own.
inline System alike_bodies(const System& body, std::size_t count) {
  System system = body;
  for (std::size_t i = 1; i < count; ++i) {
    const auto number = static_cast<double>(i);
    System other = body;
    for (Vec3d& v : other.start.velocity) v += Vec3d{0.03 * number, -0.06 * number, 0.1};
    for (const std::uint32_t pin : other.pins) other.start.velocity[pin] = {};
    append_body(system, other, {0.3 * number, 0.01 * number, 0});
  }
  return system;
}

}  // namespace mssim
