#include <unistd.h>

#include <exception>

#include "backends/backends.h"
#include "backends/devices/drivers.h"
#include "integrators/all_integrators.h"

namespace mssim {
namespace {

constexpr GridPatch patch{.rows = 50, .columns = 50, .spacing = 0.01};

void add_node(System& system, const Vec3d& position) {
  system.start.add(position, {});
  system.node_mass.push_back(1e-4);
}

/// A patch at rest, as a cloth or as the only panel of a garment whose seam has one joint.
System patch_system(SteppedKind kind) {
  System system;
  for (std::uint32_t row = 0; row < patch.rows; ++row)
    for (std::uint32_t column = 0; column < patch.columns; ++column)
      add_node(system, {patch.spacing * column, 1 + patch.spacing * row, 0});
  system.materials = {{200, 0.01}, {60, 0.003}, {8, 0.0004}};
  system.springs = springs_of(patch);
  system.topology = patch;
  if (kind == SteppedKind::garment) {
    Garment garment;
    garment.panels.push_back({.name = "patch", .rows = patch.rows, .columns = patch.columns});
    garment.flat = system.start.position;
    garment.seams.emplace_back("seam");
    const std::uint32_t right = patch.node(0, patch.columns - 1);
    garment.joints.push_back({.edge_first = right, .edge_second = right, .length = patch.spacing});
    system.topology = garment;
  }
  return system;
}

/// Single tetrahedra.
System bodies_system(std::uint32_t bodies) {
  System system;
  TetrahedralMesh mesh;
  for (std::uint32_t body = 0; body < bodies; ++body) {
    const std::uint32_t a = 4 * body, b = a + 1, c = a + 2, d = a + 3;
    const double x = body;
    for (const Vec3d& position : {Vec3d{x, 1, 0}, Vec3d{x + 0.5, 1, 0}, Vec3d{x, 1.5, 0}, Vec3d{x, 1, 0.5}})
      add_node(system, position);
    for (const std::uint32_t other : {b, c, d}) system.springs.push_back({a, other, 0.5F, 0});
    for (const auto& [first, second] : {std::pair{b, c}, {b, d}, {c, d}})
      system.springs.push_back({first, second, 0.70710678F, 0});
    mesh.tetrahedra.push_back({a, b, c, d});
  }
  system.materials = {{100, 0.01}};
  system.topology = mesh;
  return system;
}

System small_system(SteppedKind kind) {
  constexpr std::uint32_t as_many_as_lanes = 16;
  if (kind == SteppedKind::bodies) return bodies_system(1);
  return kind == SteppedKind::alike_bodies ? bodies_system(as_many_as_lanes) : patch_system(kind);
}

}  // namespace

void run_driver_trial(std::span<char*> arguments) {
  rely_on_opencl_drivers();
  constexpr double dt_s = 1e-5;
  try {
    const DriverTrial trial = driver_trial_from(arguments);
    const BackendInfo* const backend = find_backend(trial.backend);
    const Integrator* const integrator = find_integrator(trial.integrator);
    if (backend != nullptr && integrator != nullptr)
      make_backend(*backend, small_system(trial.kind), *integrator, dt_s, trial.execution);
  } catch (const std::exception&) {  // NOLINT(bugprone-empty-catch)
  }
  // Do not wait for what drivers do at the end of a process.
  ::_exit(0);
}

}  // namespace mssim
