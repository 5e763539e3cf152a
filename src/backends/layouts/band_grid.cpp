#include "backends/layouts/band_grid.h"

#include <algorithm>

namespace mssim {
BandGrid::BandGrid(const System& system, const GridPatch& grid, const Integrator& method, double dt_s,
                   std::size_t lanes, std::size_t most_threads, const BandCut& given)
    : layout(grid, lanes),
      integrator(&method),
      coefficients(coefficients_of<float>(method, dt_s)),
      surroundings(surroundings_of(system)),
      columns(layout.columns),
      own(given.piece.value_or(ColumnRange{0, columns})),
      spacing_(grid.spacing),
      first_column_(grid.first_column) {
  steps_per_pass = given.steps_per_pass.value_or(
      steps_per_pass_for(layout, method, partitions_for(own.count, most_threads, method, 1)));
  if (!given.piece && given.halves.value_or(halves_for(layout, method, steps_per_pass, most_threads)) > 1) {
    layout = BandLayout(grid, lanes, 2);
    const std::size_t ghosts = ghost_columns(method, steps_per_pass);
    own = {ghosts, (columns + 1) / 2};
    columns = own.end() + ghosts;
  }
  cut(most_threads);
  const std::vector<SpringConstants> springs = spring_constants_of(system, grid);
  for (BandPartition& partition : partitions) {
    make_arrays(partition);
    choose_rows(partition, springs);
    add_pins(partition, system);
  }
  for (std::size_t p = 0; p + 1 < partitions.size(); ++p)
    for (EdgeColumns* edge : {&partitions[p].right, &partitions[p + 1].left})
      for (AlignedArray& set : edge->sets)
        set = AlignedArray(partitions[p].ghosts * EdgeColumns::column_floats(layout));
}

void BandGrid::cut(std::size_t most_threads) {
  const std::size_t ghosts = ghost_columns(*integrator, steps_per_pass);
  const bool is_piece = layout.halves == 1;  // or all: then there is nothing beside it
  const bool left = is_piece && own.first > 0, right = is_piece && own.end() < columns;
  const std::size_t edge_columns = ghosts * (std::size_t{left} + std::size_t{right});
  const bool has_edges = own.count >= edge_columns + narrowest_partition(*integrator, steps_per_pass);
  ColumnRange inner = own;
  if (has_edges && left) {
    add_partition({own.first, ghosts});
    inner = {own.first + ghosts, inner.count - ghosts};
  }
  if (has_edges && right) inner.count -= ghosts;
  first_inner = partitions.size();
  // Without edges one partition has them all: messages bring the ghosts of the first and the last alone.
  threads = (left || right) && !has_edges
                ? 1
                : partitions_for(inner.count, most_threads, *integrator, steps_per_pass);
  for (std::size_t p = 0; p < threads; ++p) add_partition(part_of(inner, p, threads));
  if (has_edges && right) add_partition({inner.end(), ghosts});
}

void BandGrid::add_partition(ColumnRange its) {
  BandPartition& partition = partitions.emplace_back();
  partition.first = its.first;
  partition.count = its.count;
  partition.ghosts = ghost_columns(*integrator, steps_per_pass);
  partition.first_of_cloth = layout.halves == 1 ? its.first : layout.halves * (its.first - own.first);
}

void BandGrid::make_arrays(BandPartition& partition) const {
  const std::size_t local_columns = partition.ghosts + partition.count + partition.ghosts;
  for (const Pair pair : stored_pairs(*integrator, Storage::in_place))
    partition.pairs[index(pair)] =
        AlignedArray((pair == Pair::state ? local_columns : ring_columns) * layout.column_floats());
  partition.forces = AlignedArray(stages_under_way * 2 * layout.force_floats());
}

ColumnRange BandGrid::filled_columns(const BandPartition& partition) const {
  return with_ghosts({partition.first, partition.count}, partition.ghosts, columns);
}

void BandGrid::choose_rows(BandPartition& partition, const std::vector<SpringConstants>& springs) {
  const auto to_end = [&](std::ptrdiff_t column) {
    const auto left = static_cast<std::ptrdiff_t>(layout.columns) - column;
    if (column < 0 || left < 0) return std::size_t{0};
    return std::min(static_cast<std::size_t>(left), BandRows::far_from_end);
  };
  const ColumnRange filled = filled_columns(partition);
  partition.column_rows.resize(partition.ghosts + partition.count + partition.ghosts);
  for (std::size_t column = filled.first; column < filled.end(); ++column) {
    ColumnsToEnd key{};
    for (std::size_t half = 0; half < layout.halves; ++half)
      key[half] = to_end(partition.cloth_column(column, half));
    partition.column_rows[partition.local(column)] =
        &band_rows.try_emplace(key, layout, springs, surroundings.gravity, key).first->second;
  }
}

void BandGrid::add_pins(BandPartition& partition, const System& system) const {
  const ColumnRange filled = filled_columns(partition);
  partition.pins.resize(partition.ghosts + partition.count + partition.ghosts);
  for (const std::uint32_t node : system.pins)
    for (std::size_t half = 0; half < layout.halves; ++half) {
      const std::size_t row = node / layout.columns;
      const std::ptrdiff_t behind =
          static_cast<std::ptrdiff_t>(node % layout.columns) - partition.cloth_column(filled.first, half);
      if (behind < 0 || static_cast<std::size_t>(behind) >= filled.count) continue;
      const Vec3<float> position = vec3_cast<float>(system.start.position[node]);
      partition.pins[partition.local(filled.first + static_cast<std::size_t>(behind))].push_back(
          {layout.offset(row, half), {position.x, position.y, position.z}});
    }
}

void BandGrid::fill_partition(BandPartition& partition, const State& state) const {
  // Above the floor, of which there may be none (without_floor): what springs reach must be finite.
  constexpr double lowest_floor = -1e6;
  const double dummy_height = std::max(static_cast<double>(surroundings.floor_height), lowest_floor) + 1;
  const ColumnRange filled = filled_columns(partition);
  for (std::size_t column = filled.first; column < filled.end(); ++column) {
    float* out = partition.column(layout, Pair::state, column) + layout.offset(0);
    for (std::size_t r = 0; r < layout.height; ++r, out += layout.row_floats())
      for (std::size_t lane = 0; lane < layout.lanes; ++lane) {
        const std::size_t row = lane % layout.bands * layout.height + r;
        const std::ptrdiff_t of_cloth = partition.cloth_column(column, lane / layout.bands);
        // Dummies keep the spacing of a cloth at rest, also from those of other pieces: no spring between
        // them may have length zero, though none has stiffness.
        Vec3d x{static_cast<double>(static_cast<std::ptrdiff_t>(first_column_) + of_cloth) * spacing_,
                dummy_height, static_cast<double>(row) * spacing_};
        Vec3d v{};
        if (row < layout.rows && of_cloth >= 0 && of_cloth < static_cast<std::ptrdiff_t>(layout.columns)) {
          const std::size_t node = row * layout.columns + static_cast<std::size_t>(of_cloth);
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
  const auto fill = [&](EdgeColumns& edge, std::size_t first, std::size_t half) {
    for (std::size_t i = 0; i < partition.ghosts; ++i) {
      const float* from = partition.column(layout, Pair::state, first + i) + layout.offset(0);
      float* to = edge.column(layout, passes, i);
      for (std::size_t n = 0; n < layout.height * BandLayout::components; ++n)
        std::copy_n(from + n * layout.lanes + half * layout.bands, layout.bands, to + n * layout.bands);
    }
    edge.pass.reach(passes);
  };
  if (p > 0) fill(partition.left, partition.first, 0);
  if (p + 1 < partitions.size())
    fill(partition.right, partition.first + partition.count - partition.ghosts, layout.halves - 1);
}

State BandGrid::state() const {
  return state({0, 0, static_cast<std::uint32_t>(layout.rows), static_cast<std::uint32_t>(layout.columns)});
}

State BandGrid::state(const GridWindow& window) const {
  State state;
  state.position.resize(window.nodes());
  state.velocity.resize(window.nodes());
  for (const BandPartition& partition : partitions)
    for (std::size_t i = 0; i < layout.halves * partition.count; ++i) {
      const std::size_t half = i / partition.count, its = partition.first + i % partition.count;
      const auto of_cloth = static_cast<std::size_t>(partition.cloth_column(its, half));
      if (of_cloth < window.column || of_cloth >= window.column + window.columns) continue;
      const float* column = partition.column(layout, Pair::state, its);
      for (std::size_t row = 0; row < window.rows; ++row) {
        const float* in = column + layout.offset(window.row + row, half);
        const std::size_t node = row * window.columns + of_cloth - window.column, step = layout.lanes;
        state.position[node] = vec3_cast<double>(Vec3<float>{in[0], in[step], in[2 * step]});
        state.velocity[node] = vec3_cast<double>(Vec3<float>{in[3 * step], in[4 * step], in[5 * step]});
      }
    }
  return state;
}

}  // namespace mssim
