#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "laws/host_laws.h"
#include "model/system.h"

namespace mssim {

/// The nodes of a system as in a straightforward implicit program: arrays in the scene's node order.
template <class Real>
struct PlainNodes {
  std::vector<Vec3<Real>> x;                     ///< [nodes] m
  std::vector<Vec3<Real>> v;                     ///< [nodes] m/s
  std::vector<Real> mass;                        ///< [nodes] kg
  std::vector<std::uint8_t> pinned;              ///< [nodes] 1 if pinned
  std::vector<SpringConstants<Real>> materials;  ///< System::materials
  Real viscous_damping{}, gravity{};
  Real floor_height{}, restitution{}, friction{};

  explicit PlainNodes(const System& system)
      : pinned(system.nodes()),
        materials(materials_of<Real>(system)),
        viscous_damping(static_cast<Real>(system.viscous_damping)),
        gravity(static_cast<Real>(system.gravity)),
        floor_height(static_cast<Real>(system.floor.height)),
        restitution(static_cast<Real>(system.floor.restitution)),
        friction(static_cast<Real>(system.floor.friction)) {
    for (const double value : system.node_mass) mass.push_back(static_cast<Real>(value));
    for (const std::uint32_t node : system.pins) pinned[node] = 1;
    set_state(system.start);
  }

  std::size_t size() const { return x.size(); }

  void set_state(const State& state) {
    x.clear();
    v.clear();
    for (std::size_t i = 0; i < state.position.size(); ++i) {
      x.push_back(vec3_cast<Real>(state.position[i]));
      v.push_back(vec3_cast<Real>(state.velocity[i]));
    }
  }

  State state() const {
    State state;
    for (std::size_t i = 0; i < x.size(); ++i) state.add(vec3_cast<double>(x[i]), vec3_cast<double>(v[i]));
    return state;
  }

  /// Applies the floor at a step's end, as for explicit integrators.
  void touch_floor() {
    for (std::size_t i = 0; i < x.size(); ++i)
      if (!pinned[i]) mssim::touch_floor(x[i], v[i], floor_height, restitution, friction);
  }
};

}  // namespace mssim
