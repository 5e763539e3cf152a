#include "backends/layouts/band_grid.h"

#include <unistd.h>

#include <algorithm>

namespace mssim {
namespace {

constexpr std::size_t halo = BandLayout::halo;

/// Threads recompute two columns a stage and side; a partition narrower than this would be mostly that. Its
/// ghosts belong to the partitions beside it.
std::size_t narrowest_part(const Integrator& integrator, std::size_t steps_per_pass) {
  return std::max(2 * halo * integrator.stage_count, ghost_columns(integrator, steps_per_pass));
}

}  // namespace

/// Steps to take in one pass. A state that the last-level cache holds (the half of it that one may count on)
/// is best left there: more columns under way than the first-level cache holds cost 4 to 12 % at 350,000
/// nodes. From memory, as many as there is room for among the stages under way: semi-euler was 1.9 times as
/// fast with four at a million nodes and 1.8 times with columns of 4,000 rows. Ghost columns must stay a
/// small share.
std::size_t steps_per_pass_for(const BandLayout& layout, const Integrator& integrator,
                               std::size_t partitions) {
  constexpr long usual_cache = 16L << 20;  // bytes, where the system does not say
  constexpr std::size_t columns_per_stage = 16;
  const long found = sysconf(_SC_LEVEL3_CACHE_SIZE);
  const auto cache = static_cast<std::size_t>(found > 0 ? found : usual_cache);
  const std::size_t steps = stages_under_way / integrator.stage_count;
  const bool fits = layout.columns * layout.column_floats() * sizeof(float) <= cache / 2;
  const bool narrow =
      partitions > 1 && layout.columns / partitions < columns_per_stage * steps * integrator.stage_count;
  return fits || narrow ? 1 : steps;
}

BandGrid::BandGrid(const System& system, const GridPatch& grid, const Integrator& method, double dt_s,
                   std::size_t lanes, std::size_t threads, std::optional<std::size_t> steps_in_a_pass,
                   std::optional<ColumnRange> piece)
    : layout(grid, lanes),
      integrator(&method),
      coefficients(coefficients_of<float>(method, dt_s)),
      surroundings(surroundings_of(system)),
      band_rows(layout, spring_constants_of(system, grid), surroundings.gravity),
      own(piece.value_or(ColumnRange{0, layout.columns})),
      spacing_(grid.spacing),
      first_column_(grid.first_column) {
  const std::size_t most_partitions =
      std::clamp<std::size_t>(threads, 1, std::max<std::size_t>(1, own.count / narrowest_part(method, 1)));
  steps_per_pass = steps_in_a_pass.value_or(steps_per_pass_for(layout, method, most_partitions));
  cut(most_partitions);
  for (BandPartition& partition : partitions) {
    const std::size_t columns = partition.ghosts + partition.count + partition.ghosts;
    for (const Pair pair : stored_pairs(method, Storage::in_place))
      partition.pairs[index(pair)] =
          AlignedArray((pair == Pair::state ? columns : ring_columns) * layout.column_floats());
    partition.forces = AlignedArray(stages_under_way * 3 * layout.force_floats());
    partition.pins.resize(columns);
  }
  for (std::size_t p = 0; p + 1 < partitions.size(); ++p)
    for (EdgeColumns* edge : {&partitions[p].right, &partitions[p + 1].left})
      for (AlignedArray& set : edge->sets)
        set = AlignedArray(partitions[p].ghosts * EdgeColumns::column_floats(layout));
  for (const std::uint32_t node : system.pins) {
    const std::size_t row = node / layout.columns, column = node % layout.columns;
    for (BandPartition& partition : partitions) {
      if (column + partition.ghosts < partition.first || partition.local(column) >= partition.pins.size())
        continue;
      const Vec3<float> position = vec3_cast<float>(system.start.position[node]);
      partition.pins[partition.local(column)].push_back(
          {layout.offset(row), {position.x, position.y, position.z}});
    }
  }
}

void BandGrid::cut(std::size_t threads) {
  const std::size_t ghosts = ghost_columns(*integrator, steps_per_pass);
  const std::size_t narrowest = narrowest_part(*integrator, steps_per_pass);
  const auto add = [&](ColumnRange columns) {
    BandPartition& partition = partitions.emplace_back();
    partition.first = columns.first;
    partition.count = columns.count;
    partition.ghosts = ghosts;
  };
  const bool left = own.first > 0, right = own.end() < layout.columns;
  const std::size_t edge_columns = ghosts * (std::size_t{left} + std::size_t{right});
  const bool has_edges = own.count >= edge_columns + narrowest;
  ColumnRange inner = own;
  if (has_edges && left) {
    add({own.first, ghosts});
    inner = {own.first + ghosts, inner.count - ghosts};
  }
  if (has_edges && right) inner.count -= ghosts;
  first_inner = partitions.size();
  // Without edges one partition has them all: messages bring the ghosts of the first and the last alone.
  inner_count = (left || right) && !has_edges
                    ? 1
                    : std::clamp<std::size_t>(threads, 1, std::max<std::size_t>(1, inner.count / narrowest));
  for (std::size_t p = 0; p < inner_count; ++p) add(part_of(inner, p, inner_count));
  if (has_edges && right) add({inner.end(), ghosts});
}

void BandGrid::fill_partition(BandPartition& partition, const State& state) const {
  // Above the floor, of which there may be none (without_floor): what springs reach must be finite.
  constexpr double lowest_floor = -1e6;
  const double dummy_height = std::max(static_cast<double>(surroundings.floor_height), lowest_floor) + 1;
  const ColumnRange filled =
      with_ghosts({partition.first, partition.count}, partition.ghosts, layout.columns);
  for (std::size_t column = filled.first; column < filled.end(); ++column) {
    float* out = partition.column(layout, Pair::state, column) + halo * layout.row_floats();
    for (std::size_t r = 0; r < layout.height; ++r, out += layout.row_floats())
      for (std::size_t lane = 0; lane < layout.lanes; ++lane) {
        const std::size_t row = lane * layout.height + r;
        // Dummies keep the spacing of a cloth at rest, also from those of other pieces: no spring between
        // them may have length zero, though none has stiffness.
        Vec3d x{static_cast<double>(first_column_ + column) * spacing_, dummy_height,
                static_cast<double>(row) * spacing_};
        Vec3d v{};
        if (row < layout.rows) {
          const std::size_t node = row * layout.columns + column;
          x = state.position[node];
          v = state.velocity[node];
        }
        const std::array<double, BandLayout::components> value{x.x, x.y, x.z, v.x, v.y, v.z};
        for (std::size_t k = 0; k < value.size(); ++k)
          out[k * layout.lanes + lane] = static_cast<float>(value[k]);
      }
  }
}

void BandGrid::set_state(const State& state) {
#pragma omp parallel for num_threads(static_cast <int>(partitions.size())) schedule(static, 1)
  for (std::size_t p = 0; p < partitions.size(); ++p) {
    fill_partition(partitions[p], state);
    fill_edges(p);
  }
}

void BandGrid::fill_edges(std::size_t p) {
  BandPartition& partition = partitions[p];
  const auto fill = [&](EdgeColumns& edge, std::size_t first) {
    for (std::size_t i = 0; i < partition.ghosts; ++i)
      std::copy_n(partition.column(layout, Pair::state, first + i) + halo * layout.row_floats(),
                  EdgeColumns::column_floats(layout), edge.column(layout, passes, i));
    edge.pass.reach(passes);
  };
  if (p > 0) fill(partition.left, partition.first);
  if (p + 1 < partitions.size()) fill(partition.right, partition.first + partition.count - partition.ghosts);
}

State BandGrid::state() const {
  return state({0, 0, static_cast<std::uint32_t>(layout.rows), static_cast<std::uint32_t>(layout.columns)});
}

State BandGrid::state(const GridWindow& window) const {
  State state;
  state.position.resize(window.nodes());
  state.velocity.resize(window.nodes());
  for (const BandPartition& partition : partitions) {
    const std::size_t begin = std::max<std::size_t>(partition.first, window.column);
    const std::size_t end =
        std::min<std::size_t>(partition.first + partition.count, window.column + window.columns);
    for (std::size_t c = begin; c < end; ++c) {
      const float* column = partition.column(layout, Pair::state, c);
      for (std::size_t row = 0; row < window.rows; ++row) {
        const float* in = column + layout.offset(window.row + row);
        const std::size_t node = row * window.columns + c - window.column, step = layout.lanes;
        state.position[node] = vec3_cast<double>(Vec3<float>{in[0], in[step], in[2 * step]});
        state.velocity[node] = vec3_cast<double>(Vec3<float>{in[3 * step], in[4 * step], in[5 * step]});
      }
    }
  }
  return state;
}

}  // namespace mssim
