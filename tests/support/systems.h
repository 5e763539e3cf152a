#pragma once

#include "bench/verification/verification.h"
#include "geometry/vec3.h"
#include "integrators/integrator.h"
#include "model/system.h"
#include "scene/scene_kinds.h"
#include "scene/spec/scene_spec.h"
#include "tests/support/testing.h"

namespace mssim {

/// A small cloth of the committed scenes' material, high above the floor, for tests to change.
inline SceneSpec cloth_spec(std::uint32_t rows, std::uint32_t columns, double ceiling_height_m = 1,
                            std::optional<ClothPins> pins = ClothPins{0, 10}) {
  ClothSpec cloth;
  cloth.rows = rows;
  cloth.columns = columns;
  cloth.spacing_m = 0.01;
  cloth.areal_density_kg_per_m2 = 0.2;
  cloth.ceiling_height_m = ceiling_height_m;
  cloth.pins = pins;
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

inline System cloth_system(std::uint32_t rows, std::uint32_t columns, double ceiling_height_m = 1,
                           std::optional<ClothPins> pins = ClothPins{0, 10}) {
  return build_system(cloth_spec(rows, columns, ceiling_height_m, pins));
}

/// A flat sheet at rest, without pins, at `height_m`.
inline SceneSpec sheet_spec(std::uint32_t rows, std::uint32_t columns, double height_m) {
  SceneSpec spec = cloth_spec(rows, columns, height_m, {});
  std::get<ClothSpec>(spec.content).ripple = {0, 1, 0};
  return spec;
}

/// A rippled cloth without pins, gravity, damping by the air: nothing outside the cloth acts on it.
inline System lone_cloth(std::uint32_t rows, std::uint32_t columns) {
  SceneSpec spec = cloth_spec(rows, columns, 1, {});
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

/// The same, held at these nodes, which do not move.
inline System pinned(System system, std::vector<std::uint32_t> pins) {
  system.pins = std::move(pins);
  for (const std::uint32_t pin : system.pins) system.start.velocity[pin] = {};
  return system;
}

/// The same, held at some nodes all over it, the last one too.
inline System pinned_all_over(const System& system) {
  const auto nodes = static_cast<std::uint32_t>(system.nodes());
  std::vector<std::uint32_t> pins;
  for (std::uint32_t node = 2; node + 1 < nodes; node += 17) pins.push_back(node);
  if (nodes > 1) pins.push_back(nodes - 1);
  return pinned(system, std::move(pins));
}

/// The same with springs at rest where it starts.
inline System relaxed(System system) {
  for (Spring& spring : system.springs)
    spring.rest_length = static_cast<float>(
        length(system.start.position[spring.second] - system.start.position[spring.first]));
  return system;
}

/// Whether a node lies on the floor or rises from it.
inline bool has_met_floor(const System& system, const State& state) {
  for (std::size_t node = 0; node < system.nodes(); ++node)
    if (state.velocity[node].y > 0 || state.position[node].y == system.floor.height) return true;
  return false;
}

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

/// A small body with a node that hangs on nothing.
inline System block_and_lone_node() {
  System system = solid_block(3, 3, 3);
  system.start.add({0.25, 0.75, 0.125}, {});
  system.node_mass.push_back(0.003);
  return system;
}

/// Cloths and bodies where layouts go wrong: fewer rows or columns than lanes, single rows and columns, rows
/// and slices that are not full, several chunks, bodies of unlike nodes and materials.
inline std::vector<System> odd_systems() {
  std::vector<System> systems;
  for (const auto& [rows, columns] : {std::pair{50U, 50U},
                                      {37U, 23U},
                                      {17U, 30U},
                                      {9U, 11U},
                                      {3U, 40U},
                                      {40U, 3U},
                                      {2U, 2U},
                                      {1U, 7U},
                                      {7U, 1U}})
    systems.push_back(cloth_system(rows, columns));
  systems.insert(systems.end(),
                 {solid_block(2, 2, 2), solid_block(3, 3, 7), solid_block(9, 9, 9), two_solid_blocks()});
  return systems;
}

/// `count` bodies like this one in one system, each in its own place and with velocities of its own.
inline System alike_bodies(const System& body, std::size_t count) {
  System system = body;
  for (std::size_t i = 1; i < count; ++i) {
    const auto number = static_cast<double>(i);
    System other = body;
    for (Vec3d& v : other.start.velocity) v += Vec3d{0.03 * number, -0.06 * number, 0.1};
    append_body(system, pinned(other, body.pins), {0.3 * number, 0.01 * number, 0});
  }
  return system;
}

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

/// The step that tests of backends take with the cloths and blocks of this file, which are stable with it.
inline constexpr double backend_dt_s = 1e-4;

/// The same for any integrator: explicit Euler takes half of it, with which their damping keeps it from
/// growing.
constexpr double backend_dt_of(const Integrator& integrator) {
  return integrator.name == "explicit-euler" ? backend_dt_s / 2 : backend_dt_s;
}

/// Such steps in `seconds`.
inline int steps_in(const Integrator& integrator, double seconds) {
  return static_cast<int>(std::lround(seconds / backend_dt_of(integrator)));
}

/// How far `steps` of free fall from rest lead, in units of g dt^2. Semi-implicit and backward
/// Euler move with the speed at each step's end, explicit Euler with that at its start.
constexpr double fall_of(const Integrator& integrator, double steps) {
  const bool backward = is_implicit(integrator) && integrator.solver != Solver::constraints;
  if (backward || integrator.name == "semi-euler") return steps * (steps + 1) / 2;
  if (integrator.name == "explicit-euler") return steps * (steps - 1) / 2;
  return steps * steps / 2;
}

/// Of each of `a` from the same of `b`; infinite where one is not finite.
inline double largest_distance(const std::vector<Vec3d>& a, const std::vector<Vec3d>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Vec3d d = a[i] - b[i];
    largest = std::isfinite(dot(d, d)) ? std::max(largest, std::sqrt(dot(d, d))) : HUGE_VAL;
  }
  return largest;
}

/// Whether an instruction set, by Highway's name, has multiply-adds, which round once where a product and a
/// sum round twice.
inline bool fuses(std::string_view instruction_set) {
  return instruction_set == "AVX3" || instruction_set == "AVX2" || instruction_set == "NEON";
}

}  // namespace mssim
