#include "backends/grid_bands/band_sheet.h"

#include <algorithm>

#include "backends/backend.h"

namespace mssim {
namespace {

constexpr Storage storage =
    Storage::in_place;  // a spring points forward, so nothing behind the walk is read again
constexpr std::size_t halo = BandLayout::halo;

/// A part narrower than its neighbours' ghosts would make them reach over it.
constexpr std::size_t narrowest_part = 2 * halo;

BandLayout layout_for(const GridPatch& grid, std::size_t lanes) {
  BandLayout layout;
  layout.lanes = lanes;
  layout.rows = grid.rows;
  layout.columns = grid.columns;
  layout.height = std::max(halo, (layout.rows + lanes - 1) / lanes);
  return layout;
}

}  // namespace

BandSheet::BandSheet(const System& system, const GridPatch& grid, const Integrator& method, double dt_s,
                     std::size_t lanes, std::size_t threads)
    : layout(layout_for(grid, lanes)),
      integrator(&method),
      coefficients(coefficients_of<float>(method, dt_s)),
      surroundings(surroundings_of(system)),
      spacing_(grid.spacing) {
  const double mass = require_uniform_mass(system);
  for (std::size_t kind = 0; kind < materials.size(); ++kind) {
    const double stiffness = system.materials[kind].stiffness / mass;
    const double rest = static_cast<double>(grid.rest_length(static_cast<GridSpringKind>(kind)));
    materials[kind] = {static_cast<float>(stiffness), static_cast<float>(stiffness * rest),
                       static_cast<float>(system.materials[kind].damping / mass)};
  }

  parts.resize(
      std::clamp<std::size_t>(threads, 1, std::max<std::size_t>(1, layout.columns / narrowest_part)));
  for (std::size_t p = 0; p < parts.size(); ++p) {
    BandPart& part = parts[p];
    part.first = layout.columns * p / parts.size();
    part.count = layout.columns * (p + 1) / parts.size() - part.first;
    for (std::size_t pair = 0; pair < pair_kinds; ++pair) {
      const auto role = static_cast<Pair>(pair);
      if (stores(method, role, storage))
        part.pairs[pair] = AlignedArray((part.count + 2 * halo) * layout.column_floats());
      part.base[pair] = part.pairs[index(storage_of(method, role, storage))].data();
    }
    part.forces = AlignedArray(method.stage_count * 3 * layout.force_floats());
    part.pins.resize(part.count);
  }
  for (const std::uint32_t node : system.pins) {
    const std::size_t row = node / layout.columns, column = node % layout.columns;
    for (BandPart& part : parts) {
      if (column < part.first || column >= part.first + part.count) continue;
      const Vec3<float> position = vec3_cast<float>(system.start.position[node]);
      part.pins[column - part.first].push_back(
          {(row % layout.height + halo) * layout.row_floats() + row / layout.height,
           {position.x, position.y, position.z}});
    }
  }
}

void BandSheet::fill_part(BandPart& part, const State& state) const {
  const auto reach = static_cast<std::ptrdiff_t>(halo);
  const auto rows = static_cast<std::ptrdiff_t>(layout.rows),
             columns = static_cast<std::ptrdiff_t>(layout.columns);
  const auto height = static_cast<std::ptrdiff_t>(layout.height);
  for (std::size_t pair = 0; pair < pair_kinds; ++pair) {
    const auto role = static_cast<Pair>(pair);
    if (!stores(*integrator, role, storage)) continue;
    part.base[pair] = part.pairs[pair].data();  // roles as at the start of a step
    for (std::ptrdiff_t c = -reach; c < static_cast<std::ptrdiff_t>(part.count) + reach; ++c) {
      float* out = part.column(layout, role, c);
      const std::ptrdiff_t column = static_cast<std::ptrdiff_t>(part.first) + c;
      for (std::ptrdiff_t r = -reach; r < height + reach; ++r, out += layout.row_floats())
        for (std::size_t lane = 0; lane < layout.lanes; ++lane) {
          const std::ptrdiff_t row = static_cast<std::ptrdiff_t>(lane) * height + r;
          // Dummies keep the spacing of a cloth at rest, above the floor: their springs give small finite
          // numbers.
          Vec3d x{static_cast<double>(column) * spacing_, static_cast<double>(surroundings.floor_height) + 1,
                  static_cast<double>(row) * spacing_};
          Vec3d v{};
          if (row >= 0 && row < rows && column >= 0 && column < columns) {
            const auto node = static_cast<std::size_t>(row * columns + column);
            x = state.position[node];
            v = state.velocity[node];
          }
          const std::array<double, BandLayout::components> value{x.x, x.y, x.z, v.x, v.y, v.z};
          for (std::size_t k = 0; k < value.size(); ++k)
            out[k * layout.lanes + lane] = static_cast<float>(value[k]);
        }
    }
  }
}

void BandSheet::set_state(const State& state) {
#pragma omp parallel for num_threads(static_cast <int>(parts.size())) schedule(static, 1)
  for (std::size_t p = 0; p < parts.size(); ++p) fill_part(parts[p], state);
}

State BandSheet::state() const {
  State state;
  const std::size_t nodes = layout.rows * layout.columns;
  state.position.resize(nodes);
  state.velocity.resize(nodes);
  for (const BandPart& part : parts)
    for (std::size_t c = 0; c < part.count; ++c) {
      const float* column = part.column(layout, Pair::state, static_cast<std::ptrdiff_t>(c));
      for (std::size_t row = 0; row < layout.rows; ++row) {
        const float* in = column + (row % layout.height + halo) * layout.row_floats() + row / layout.height;
        const std::size_t node = row * layout.columns + part.first + c, step = layout.lanes;
        state.position[node] = vec3_cast<double>(Vec3<float>{in[0], in[step], in[2 * step]});
        state.velocity[node] = vec3_cast<double>(Vec3<float>{in[3 * step], in[4 * step], in[5 * step]});
      }
    }
  return state;
}

}  // namespace mssim
