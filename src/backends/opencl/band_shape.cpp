#include "backends/opencl/band_shape.h"

#include <algorithm>
#include <bit>

namespace mssim {
namespace {

constexpr std::size_t halo = BandLayout::halo;

}  // namespace

BandShape::BandShape(const GridPatch& grid, const Integrator& integrator, std::size_t lanes,
                     std::size_t units, std::uint64_t cache_bytes,
                     std::optional<std::size_t> steps_in_a_launch)
    : bands(grid, lanes) {
  constexpr std::size_t most_stages = 16;  // whose columns still fit a second-level cache
  constexpr std::size_t most_partitions_per_unit = 4;
  // A state that half of the cache does not hold comes from memory: more steps a launch also make fewer
  // passes over it, as in the host's walk.
  const bool fits = bands.columns * bands.column_floats() * sizeof(float) <= cache_bytes / 2;
  const std::size_t fewest = fits ? 1 : stages_under_way / integrator.stage_count;
  const std::size_t first = steps_in_a_launch.value_or(fewest);
  const std::size_t last = steps_in_a_launch.value_or(most_stages / integrator.stage_count);
  BandShape best = with(first, units, integrator);
  for (std::size_t count = first; count <= last; ++count)
    for (std::size_t per_unit = 1; per_unit <= most_partitions_per_unit; ++per_unit) {
      const BandShape shape = with(count, per_unit * units, integrator);
      if (shape.step_cost(integrator, units) < best.step_cost(integrator, units)) best = shape;
    }
  *this = best;
}

BandShape BandShape::with(std::size_t steps_in_a_launch, std::size_t most_partitions,
                          const Integrator& integrator) const {
  BandShape shape = *this;
  shape.steps = steps_in_a_launch;
  shape.ghosts = halo * integrator.stage_count * shape.steps;
  // A partition's ghosts belong to the partitions beside it.
  shape.partitions = std::clamp<std::size_t>(bands.columns / shape.ghosts, 1, most_partitions);
  return shape;
}

double BandShape::step_cost(const Integrator& integrator, std::size_t units) const {
  // In units of 4 ns, which a node and stage takes with PoCL on two cores of Zen 4 or of an Intel Xeon. A
  // launch that wakes both threads of a virtual machine takes 36 to 41 microseconds on the Xeon; on Zen 4 one
  // of next to nothing, which wakes one, took 4. With a number between them the steps chosen were at most 2 %
  // from the best on the Xeon, and are so where a launch takes 6 microseconds, if these costs hold. More
  // steps make fewer launches and more ghosts, which are computed twice; more partitions leave some of the
  // share of a compute unit that was held up to the others.
  constexpr double launch = 6000;
  constexpr double unevenness = 0.05;  // of a partition's time, by which the last one is later
  const auto number = [](std::size_t count) { return static_cast<double>(count); };
  // The first stage walks over all ghosts of a side, the last one over none.
  const double sides = std::min(number(partitions) - 1, 2.0);
  const double columns = number(bands.columns) / number(partitions) + sides / 2 * number(ghosts);
  const double in_turn = std::max(1.0, number(partitions) / number(units));
  return launch / number(steps) +
         number(integrator.stage_count * bands.rows) * columns * (in_turn + unevenness);
}

std::size_t BandShape::ring() const { return std::bit_ceil(ghosts); }

PairLayout BandShape::state_layout() const {
  PairLayout pair = column_layout();
  pair.floats = bands.columns * bands.column_floats();
  for (const auto& [offset, row] : rows_in_bands())
    for (std::size_t column = 0; column < bands.columns; ++column)
      pair.node.push_back(column * bands.column_floats() + offset);
  const Places halos = rows_in_halos();
  for (std::size_t column = 0; column < bands.columns; ++column)
    add_column(pair, column * bands.column_floats(), column, halos);
  return pair;
}

PairLayout BandShape::ghost_layout() const {
  PairLayout pair = column_layout();
  pair.floats = partitions * 2 * ghosts * bands.column_floats();
  const Places in_bands = rows_in_bands(), in_halos = rows_in_halos();
  for (std::size_t partition = 0; partition < partitions; ++partition)
    for (std::size_t ghost = 0; ghost < 2 * ghosts; ++ghost) {
      const std::size_t column = first(ghost < ghosts ? partition : partition + 1) + ghost - ghosts;
      if (column >= bands.columns) continue;  // left of the cloth it wraps to a huge number
      for (const Places* rows : {&in_bands, &in_halos})
        add_column(pair, (partition * 2 * ghosts + ghost) * bands.column_floats(), column, *rows);
    }
  return pair;
}

PairLayout BandShape::column_layout() const {
  PairLayout pair;
  for (std::size_t i = 0; i < pair.component.size(); ++i) pair.component[i] = i * bands.lanes;
  return pair;
}

BandShape::Places BandShape::rows_in_bands() const {
  Places places;
  for (std::size_t row = 0; row < bands.rows; ++row) places.emplace_back(bands.offset(row), row);
  return places;
}

BandShape::Places BandShape::rows_in_halos() const {
  Places places;
  for (std::size_t row = 0; row < bands.rows; ++row) {
    const std::size_t lane = row / bands.height, in_band = row % bands.height + halo;
    const auto offset = [&](std::size_t layout_row, std::size_t in_lane) {
      return layout_row * bands.row_floats() + in_lane;
    };
    if (in_band < 2 * halo && lane > 0) places.emplace_back(offset(in_band + bands.height, lane - 1), row);
    if (in_band >= bands.height && lane + 1 < bands.lanes)
      places.emplace_back(offset(in_band - bands.height, lane + 1), row);
  }
  return places;
}

void BandShape::add_column(PairLayout& pair, std::size_t start, std::size_t column,
                           const Places& rows) const {
  for (const auto& [offset, row] : rows)
    pair.copies.emplace_back(start + offset, row * bands.columns + column);
}

}  // namespace mssim
