#include "backends/implicit/constraints/quartered_rows.h"

#include <algorithm>
#include <set>

#include "backends/implicit/constraints/row_blocks.h"
#include "backends/interface/backend.h"

namespace mssim {
namespace {

/// A cloth of so many bytes or fewer, which the caches nearest to the processors hold, needs no more than one
/// small step a pass; a larger one takes so many. Measured on Zen 4, on which a small step of 350,000 nodes
/// took 2.2 times as long as one of semi-implicit Euler with one a pass, 1.9 times with two, and 1.7 times
/// with five or ten; of 40,000 nodes 2.4 times with any number. More leave more to be done between the
/// threads, which only some of them do.
constexpr std::size_t cached_bytes = std::size_t{4} << 20, most_depth = 4;

/// An odd number of vectors: rows and components whose distance is a power of two share a few sets of the
/// first-level cache.
std::size_t pitch_of(std::size_t floats, std::size_t lanes) {
  const std::size_t vectors = (floats + lanes - 1) / lanes;
  return (vectors + (vectors % 2 == 0 ? 1 : 0)) * lanes;
}

}  // namespace

QuarterLayout::QuarterLayout(const GridPatch& grid, std::size_t lane_count)
    : lanes(lane_count),
      rows(grid.rows),
      columns(grid.columns),
      pitch(pitch_of((columns + streams - 1) / streams, lanes)) {}

QuarteredRows::QuarteredRows(const System& system, const GridPatch& grid, double dt_s, std::size_t lanes,
                             std::size_t thread_count)
    : layout(grid, lanes),
      nodes(layout.rows * layout.row_floats() + lanes),  // a vector of the last nodes may begin one further
      rest(layout.rows * layout.rest_row_floats()),
      surroundings(surroundings_of(system)),
      substeps(system.solver.substeps) {
  const double small_s = dt_s / system.solver.substeps, mass = require_uniform_mass(system);
  h_s = static_cast<float>(small_s);
  fall = static_cast<float>(small_s * system.gravity);
  kept = static_cast<float>(1 / (1 + small_s * system.viscous_damping));
  for (const GridSpringKind kind : {structural, shear, bending}) {
    const SpringMaterial by_mass{system.materials[kind].stiffness / mass,
                                 system.materials[kind].damping / mass};
    const auto rest_length = static_cast<double>(grid.rest_length(kind));
    of_free.emplace_back(by_mass, rest_length, small_s, 2);
    of_pinned.emplace_back(by_mass, rest_length, small_s, 1);
  }

  std::set<std::size_t> pinned_rows;
  for (const std::uint32_t node : system.pins) pinned_rows.insert(node / layout.columns);
  const std::size_t row_flags = QuarterLayout::streams * layout.pitch;
  free = AlignedArray((1 + pinned_rows.size()) * row_flags + lanes);
  const auto flag = [&](std::size_t row, std::size_t column) -> float& {
    return free.data()[row * row_flags + column % QuarterLayout::streams * layout.pitch +
                       column / QuarterLayout::streams];
  };
  for (std::size_t row = 0; row <= pinned_rows.size(); ++row)
    for (std::size_t column = 0; column < layout.columns; ++column) flag(row, column) = 1;
  free_of_row.assign(layout.rows, free.data());
  for (std::size_t i = 0; const std::size_t row : pinned_rows)
    free_of_row[row] = free.data() + ++i * row_flags;
  for (const std::uint32_t node : system.pins) {
    const auto row = std::distance(pinned_rows.begin(), pinned_rows.find(node / layout.columns));
    flag(1 + static_cast<std::size_t>(row), node % layout.columns) = 0;
  }

  const std::size_t blocks = block_count(layout.rows);
  threads = std::clamp<std::size_t>(thread_count, 1, std::max<std::size_t>(1, blocks / least_blocks(1)));
  if (nodes.bytes() > cached_bytes) depth = most_depth;
  while (threads > 1 && depth > 1 && blocks / threads < least_blocks(depth)) --depth;
  set_state(system.start);
}

void QuarteredRows::set_state(const State& state) {
  for (std::size_t node = 0; node < state.position.size(); ++node) {
    const std::size_t row = node / layout.columns, column = node % layout.columns;
    const Vec3d &x = state.position[node], &v = state.velocity[node];
    float* out = nodes.data() + layout.offset(row, column);
    for (const double value : {x.x, x.y, x.z, v.x, v.y, v.z}) {
      *out = static_cast<float>(value);
      out += layout.pitch;
    }
    out = rest.data() + layout.rest_offset(row, column);
    for (const double value : {x.x, x.y, x.z}) {
      *out = static_cast<float>(value - static_cast<double>(static_cast<float>(value)));
      out += layout.pitch;
    }
  }
}

State QuarteredRows::state() const {
  State state;
  state.position.reserve(layout.rows * layout.columns);
  state.velocity.reserve(layout.rows * layout.columns);
  const auto vector_at = [&](const float* in) {
    return vec3_cast<double>(Vec3<float>{in[0], in[layout.pitch], in[2 * layout.pitch]});
  };
  for (std::size_t row = 0; row < layout.rows; ++row)
    for (std::size_t column = 0; column < layout.columns; ++column) {
      const float* in = nodes.data() + layout.offset(row, column);
      state.position.push_back(vector_at(in) + vector_at(rest.data() + layout.rest_offset(row, column)));
      state.velocity.push_back(vector_at(in + 3 * layout.pitch));
    }
  return state;
}

}  // namespace mssim
