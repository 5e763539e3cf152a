#include "garment/stepping/dressing_rules.h"

#include <limits>

namespace mssim {
namespace {

/// kg, infinite for pins.
std::vector<float> masses_of(const System& system) {
  std::vector<float> masses(system.node_mass.begin(), system.node_mass.end());
  for (const std::uint32_t pin : system.pins) masses[pin] = std::numeric_limits<float>::infinity();
  return masses;
}

}  // namespace

bool dresses(const Integrator& integrator) { return integrator.name == "semi-euler"; }

void require_semi_euler(const Integrator& integrator) {
  if (!dresses(integrator)) throw Unsupported("a garment is dressed with semi-euler only, as published");
}

LayerCollision::LayerCollision(const System& system, const Garment& garment, int threads)
    : threads_(system.nodes() < least_shared_nodes ? 1 : threads),
      collision_(garment, masses_of(system), *garment.touching, threads_) {
  for (std::vector<float>& array : position_) array.resize(system.nodes());
  for (std::vector<float>& array : velocity_) array.resize(system.nodes());
}

void LayerCollision::put(std::size_t node, const NodeState& state) {
  const auto& [x, v] = state;
  position_[0][node] = x.x, position_[1][node] = x.y, position_[2][node] = x.z;
  velocity_[0][node] = v.x, velocity_[1][node] = v.y, velocity_[2][node] = v.z;
}

NodeState LayerCollision::at(std::size_t node) const {
  return {{position_[0][node], position_[1][node], position_[2][node]},
          {velocity_[0][node], velocity_[1][node], velocity_[2][node]}};
}

void LayerCollision::respond(double dt_s) {
  collision_.collide({{position_[0], position_[1], position_[2]}, {velocity_[0], velocity_[1], velocity_[2]}},
                     dt_s);
}

std::optional<LayerCollision> layer_collision(const System& system, const Garment& garment, int threads) {
  if (!garment.touching) return std::nullopt;
  return std::optional<LayerCollision>(std::in_place, system, garment, threads);
}

}  // namespace mssim
