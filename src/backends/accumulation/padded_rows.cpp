#include "backends/accumulation/padded_rows.h"

namespace mssim {
namespace {

std::size_t round_up(std::size_t value, std::size_t multiple) {
  return (value + multiple - 1) / multiple * multiple;
}

/// An odd number of vectors: where it is a power of two, the rows and components that a vector's springs load
/// from share a few sets of the first-level cache.
std::size_t pitch_of(std::size_t floats, std::size_t lanes) {
  const std::size_t vectors = (floats + lanes - 1) / lanes;
  return (vectors % 2 == 0 ? vectors + 1 : vectors) * lanes;
}

}  // namespace

RowLayout::RowLayout(const GridPatch& grid, std::size_t lane_count)
    : lanes(lane_count),
      rows(grid.rows),
      columns(grid.columns),
      margin(round_up(ring, lanes)),
      pitch(pitch_of(margin + columns, lanes)) {}

PaddedRows::PaddedRows(const System& system, const GridPatch& grid, const Integrator& method, double dt_s,
                       std::size_t lanes, std::size_t thread_count)
    : layout(grid, lanes),
      integrator(&method),
      coefficients(coefficients_of<float>(method, dt_s)),
      springs(spring_constants_of(system, grid)),
      surroundings(surroundings_of(system)),
      threads(thread_count) {
  for (const Pair pair : stored_pairs(method, Storage::separate)) {
    pairs[index(pair)] = AlignedArray(layout.floats());
    base[index(pair)] = pairs[index(pair)].data();
  }
  first_pin.assign(1, 0);
  for (const std::uint32_t node : system.pins) {
    const std::size_t row = node / layout.columns;
    first_pin.resize(row + 1, pins.size());
    const Vec3<float> position = vec3_cast<float>(system.start.position[node]);
    pins.push_back({layout.offset(row, node % layout.columns), {position.x, position.y, position.z}});
  }
  first_pin.resize(layout.rows + 1, pins.size());
}

void PaddedRows::set_state(const State& state) {
  for (std::size_t node = 0; node < state.position.size(); ++node) {
    const Vec3d &x = state.position[node], &v = state.velocity[node];
    float* out = base[index(Pair::state)] + layout.offset(node / layout.columns, node % layout.columns);
    for (const double value : {x.x, x.y, x.z, v.x, v.y, v.z}) {
      *out = static_cast<float>(value);
      out += layout.pitch;
    }
  }
}

State PaddedRows::state() const {
  State state;
  state.position.reserve(layout.rows * layout.columns);
  state.velocity.reserve(layout.rows * layout.columns);
  const std::size_t step = layout.pitch;
  for (std::size_t row = 0; row < layout.rows; ++row) {
    const float* in = base[index(Pair::state)] + layout.offset(row, 0);
    for (std::size_t column = 0; column < layout.columns; ++column, ++in) {
      state.position.push_back(vec3_cast<double>(Vec3<float>{in[0], in[step], in[2 * step]}));
      state.velocity.push_back(vec3_cast<double>(Vec3<float>{in[3 * step], in[4 * step], in[5 * step]}));
    }
  }
  return state;
}

}  // namespace mssim
