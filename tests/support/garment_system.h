#pragma once

#include "garment/contact/body_maps.h"
#include "integrators/all_integrators.h"
#include "model/system.h"
#include "tests/support/testing.h"

namespace mssim {

/// A square panel: rows x columns nodes, `spacing` apart, from `corner` on along `along_row` and
/// `along_column`, of unit length.
struct SquarePanel {
  std::uint32_t rows = 0, columns = 0;
  double spacing = 0;
  Vec3d corner, along_row{1, 0, 0}, along_column{0, 1, 0};
};

/// Panels at rest, without joints, pins, body or gravity; 0.4 kg/m^2, and the springs of a garment.
inline System garment_of(const std::vector<SquarePanel>& panels) {
  System system;
  system.materials = {{200, 0}, {60, 0}, {8, 0}};
  Garment garment;
  for (const SquarePanel& square : panels) {
    GarmentPanel panel{"panel " + std::to_string(garment.panels.size()), square.rows, square.columns,
                       static_cast<std::uint32_t>(system.nodes())};
    for (std::uint32_t row = 0; row < square.rows; ++row)
      for (std::uint32_t column = 0; column < square.columns; ++column) {
        system.start.position.push_back(square.corner + column * square.spacing * square.along_row +
                                        row * square.spacing * square.along_column);
        system.start.velocity.emplace_back();
        garment.flat.push_back({column * square.spacing, row * square.spacing, 0});
        system.node_mass.push_back(0.4 * square.spacing * square.spacing);
      }
    for (Spring spring : springs_of(GridPatch{square.rows, square.columns, square.spacing})) {
      spring.first += panel.first_node;
      spring.second += panel.first_node;
      system.springs.push_back(spring);
    }
    garment.panels.push_back(panel);
  }
  system.floor.height = -1000;
  system.topology = garment;
  round_to_single(system.start);
  return system;
}

inline Garment& garment_in(System& system) { return std::get<Garment>(system.topology); }
inline const Garment& garment_in(const System& system) { return std::get<Garment>(system.topology); }

/// Gives the garment the body that it meets.
inline void put_on(System& system, const Surface& body, const BodyMapSettings& settings) {
  garment_in(system).body_maps = {std::make_shared<BodyMaps>(body, settings)};
}

/// A seam of joints, node to node.
inline void sew(System& system, const std::vector<std::uint32_t>& first,
                const std::vector<std::uint32_t>& second, double length) {
  Garment& garment = garment_in(system);
  garment.seams.push_back("seam " + std::to_string(garment.seams.size()));
  for (std::size_t i = 0; i < first.size(); ++i)
    garment.joints.push_back({first[i], second[i], second[i], 0, length / static_cast<double>(first.size()),
                              1, static_cast<std::uint32_t>(garment.seams.size() - 1)});
}

/// For `dress`: on, whatever the state is.
inline bool always(const State& /*state*/, std::int64_t /*iterations*/) { return true; }

/// The integrator that tests dress garments with.
inline constexpr const Integrator& semi_euler = *find_integrator("semi-euler");

/// The step that tests dress panels of 1 cm with: 0.55 of the limit 2 / sqrt(2 sum k / m).
inline constexpr double dressing_dt_s = 1.5e-4;

}  // namespace mssim
