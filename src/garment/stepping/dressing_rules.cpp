#include "garment/stepping/dressing_rules.h"

#include <limits>

namespace mssim {

bool dresses(const Integrator& integrator) { return integrator.name == "semi-euler"; }

void require_semi_euler(const Integrator& integrator) {
  if (!dresses(integrator)) throw Unsupported("only semi-euler dresses garments, as published");
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
