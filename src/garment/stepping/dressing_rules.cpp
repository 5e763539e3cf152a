#include "garment/stepping/dressing_rules.h"

#include <algorithm>
#include <limits>

namespace mssim {

bool dresses(const Integrator& integrator) { return integrator.name == "semi-euler"; }

void require_semi_euler(const Integrator& integrator) {
  if (!dresses(integrator)) throw Unsupported("only semi-euler dresses garments");
}

void Seaming::start(const Garment& garment, const State& start) {
  sewn.assign(garment.joints.size(), start.draped ? 1 : 0);
  progress = first_progress(garment, start);
  steps = 0;
}

void Seaming::end_step(const DressingSettings& rules, double dt_s) {
  ++steps;
  if (progress.draping) return;
  progress.open_joints = static_cast<std::size_t>(std::ranges::count(sewn, 0));
  if (!ends_seaming(rules, progress, steps, dt_s)) return;
  std::ranges::fill(sewn, std::uint8_t{1});
  progress = {0, true, steps};
}

std::optional<ClothClothCollision> layer_collision(const System& system, const Garment& garment,
                                                   int threads) {
  if (!garment.touching) return std::nullopt;
  std::vector<float> masses(system.node_mass.begin(), system.node_mass.end());
  for (const std::uint32_t pin : system.pins) masses[pin] = std::numeric_limits<float>::infinity();
  return std::optional<ClothClothCollision>(std::in_place, garment, masses, *garment.touching,
                                            system.nodes() < least_shared_nodes ? 1 : threads);
}

}  // namespace mssim
