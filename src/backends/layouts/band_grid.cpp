#include "backends/layouts/band_grid.h"

#include <unistd.h>

namespace mssim {
namespace {

/// Whether the row belongs to the cloth.
bool has_row(const BandLayout& layout, std::ptrdiff_t row) {
  return row >= 0 && row < static_cast<std::ptrdiff_t>(layout.rows);
}

/// The constants of a row of the bands.
template <class Real>
std::vector<Real> values_of_row(const BandLayout& layout, const std::vector<SpringPerMassOf<Real>>& springs,
                                Real gravity, const ColumnsToEnd& to_end, std::ptrdiff_t band_row) {
  using Rows = BandRowsOf<Real>;
  const std::size_t lanes = layout.lanes;
  std::vector<Real> values((Rows::gravity_vector + 1) * lanes);
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    const std::ptrdiff_t row = static_cast<std::ptrdiff_t>(lane % layout.bands * layout.height) + band_row;
    const std::size_t columns = to_end[lane / layout.bands];
    if (columns == 0 || !has_row(layout, row)) continue;
    values[Rows::gravity_vector * lanes + lane] = gravity;
    for (std::size_t i = 0; i < grid_stencil.size(); ++i) {
      if (!has_row(layout, row + grid_stencil[i].rows)) continue;
      if (static_cast<std::size_t>(grid_stencil[i].columns) >= columns) continue;
      const SpringPerMassOf<Real>& spring = springs[grid_stencil[i].kind];
      Real* of_lane = values.data() + i * Rows::spring_vectors * lanes + lane;
      *write_constants(of_lane, lanes, spring.constants) = spring.stiffness_rest;
    }
  }
  return values;
}

constexpr std::size_t halo = BandLayout::halo;

/// Bytes of a cache, by its sysconf name; `usual` if the system does not report it.
std::size_t cache_bytes(int name, long usual) {
  const long found = sysconf(name);
  return static_cast<std::size_t>(found > 0 ? found : usual);
}

/// Columns of the narrowest partition. Threads recompute two columns per stage and side; a narrower partition
/// would mostly recompute. Its ghosts belong to the adjacent partitions.
std::size_t narrowest_partition(const Integrator& integrator, std::size_t steps_per_pass) {
  return std::max(2 * halo * integrator.stage_count, ghost_columns(integrator, steps_per_pass));
}

/// Rows, including the cost of columns in rows, of a pass over one of the partitions.
double rows_of_pass(const BandLayout& layout, const Integrator& integrator, std::size_t steps_per_pass,
                    std::size_t threads, double rows_beside) {
  // Measured on an Intel Xeon, rounded up: cost of a column whose nodes are not updated, including the copies
  // it is read from.
  constexpr double partial_column = 0.8;
  const std::size_t columns = (layout.columns + layout.halves - 1) / layout.halves;
  const std::size_t partitions = partitions_for(columns, threads, integrator, steps_per_pass);
  const std::size_t stages = integrator.stage_count * steps_per_pass;
  const bool is_cut = layout.halves > 1 || partitions > 1;
  const double sides = layout.halves > 1 || partitions > 2 ? 2 : is_cut ? 1 : 0;
  double walked = 0;
  for (std::size_t behind = 0; behind < stages; ++behind)
    walked += static_cast<double>(columns) / static_cast<double>(partitions) +
              sides * static_cast<double>(halo * behind) +
              (is_cut ? static_cast<double>(halo) * partial_column : 0);
  return walked * (static_cast<double>(layout.height) + rows_beside);
}

/// Measured on an Intel Xeon; used on every CPU for passes of several stages.
ColumnCosts usual_column_costs() { return {0.7, 0.97, cache_bytes(_SC_LEVEL1_DCACHE_SIZE, 32L << 10)}; }

}  // namespace

template <class Real>
BandRowsOf<Real>::BandRowsOf(const BandLayout& layout, const std::vector<SpringPerMassOf<Real>>& springs,
                             Real gravity, ColumnsToEnd to_end) {
  std::vector<Real> all;
  std::map<std::vector<Real>, std::uint32_t> offset_of;
  const auto beyond = static_cast<std::ptrdiff_t>(BandLayout::halo);
  const auto height = static_cast<std::ptrdiff_t>(layout.height);
  for (std::ptrdiff_t row = -beyond; row < height + beyond; ++row) {
    const std::vector<Real> values = values_of_row<Real>(layout, springs, gravity, to_end, row);
    const auto [found, is_new] = offset_of.try_emplace(values, static_cast<std::uint32_t>(all.size()));
    if (is_new) all.insert(all.end(), values.begin(), values.end());
    offsets_.push_back(found->second);
  }
  values_ = AlignedArrayOf<Real>(all.size());
  std::ranges::copy(all, values_.data());
}

std::size_t partitions_for(std::size_t columns, std::size_t threads, const Integrator& integrator,
                           std::size_t steps_per_pass) {
  return threads_for(columns / narrowest_partition(integrator, steps_per_pass), threads);
}

/// The model: with T steps per pass, a step takes c + m / T per node, where c is the time of arithmetic and
/// caches, and m that of memory, which grows with the cores that share its bandwidth. scripts/steps-a-pass
/// measures both. If half of the last-level cache holds the state, one step per pass is best: more active
/// columns than the first-level cache holds cost 4 to 12 % at 350,000 nodes. From memory, as many steps as
/// fit among the active stages: semi-euler was 1.9 times as fast with four at a million nodes and 1.8 times
/// with columns of 4,000 rows. Ghost columns must stay a small fraction.
std::size_t steps_per_pass_for(const BandLayout& layout, const Integrator& integrator,
                               std::size_t partitions) {
  constexpr std::size_t columns_per_stage = 16;
  const std::size_t cache = cache_bytes(_SC_LEVEL3_CACHE_SIZE, 16L << 20);
  const std::size_t steps = stages_under_way / integrator.stage_count;
  const bool fits = layout.columns * layout.column_floats() * layout.number_bytes <= cache / 2;
  const bool narrow =
      partitions > 1 && layout.columns / partitions < columns_per_stage * steps * integrator.stage_count;
  return fits || narrow ? 1 : steps;
}

ColumnCosts ColumnCosts::here() {
#if defined(__x86_64__)
  // On Zen 4 a column costs 1 to 1.4 rows in addition to its own, and the second-level cache, part of which
  // threads and other arrays need, is as fast as the first.
  if (__builtin_cpu_is("amd")) return {1, 0.98, cache_bytes(_SC_LEVEL2_CACHE_SIZE, 1L << 20) / 4};
#endif
  return usual_column_costs();
}

/// Folds if that clearly reduces the rows to walk through, and if a cache holds the active columns: three of
/// the state and two of forces.
std::size_t halves_for(const BandLayout& layout, const Integrator& integrator, std::size_t steps_per_pass,
                       std::size_t threads, const ColumnCosts& of_one_stage) {
  if (layout.lanes < 2) return 1;
  const ColumnCosts costs =
      integrator.stage_count * steps_per_pass == 1 ? of_one_stage : usual_column_costs();
  const BandLayout folded(
      {static_cast<std::uint32_t>(layout.rows), static_cast<std::uint32_t>(layout.columns)}, layout.lanes, 2,
      layout.number_bytes);
  const std::size_t under_way =
      (3 * folded.column_floats() + 2 * folded.force_floats()) * folded.number_bytes;
  if (under_way > costs.bytes) return 1;
  const auto rows = [&](const BandLayout& of) {
    return rows_of_pass(of, integrator, steps_per_pass, threads, costs.rows_beside);
  };
  return rows(folded) < costs.clearly_fewer * rows(layout) ? 2 : 1;
}

template <class Real>
BandGridOf<Real>::BandGridOf(const System& system, const GridPatch& grid, const Integrator& method,
                             double dt_s, std::size_t lanes, std::size_t most_threads, const BandCut& given)
    : ExplicitSteps<Real>(system, method, 1),
      layout(grid, lanes, 1, sizeof(Real)),
      columns(layout.columns),
      own(given.piece.value_or(ColumnRange{0, columns})),
      dt_s_(dt_s),
      spacing_(grid.spacing),
      first_column_(grid.first_column) {
  steps_per_pass = given.steps_per_pass.value_or(
      steps_per_pass_for(layout, method, partitions_for(own.count, most_threads, method, 1)));
  if (!given.piece && given.halves.value_or(halves_for(layout, method, steps_per_pass, most_threads)) > 1) {
    layout = BandLayout(grid, lanes, 2, sizeof(Real));
    const std::size_t ghosts = ghost_columns(method, steps_per_pass);
    own = {ghosts, (columns + 1) / 2};
    columns = own.end() + ghosts;
  }
  cut(most_threads);
  this->surroundings.gravity = static_cast<Real>(system.gravity * dt_s * dt_s);
  this->surroundings.viscous_damping = static_cast<Real>(system.viscous_damping * dt_s);
  const auto springs = springs_per_mass<Real>(system, grid, dt_s);
  for (Partition& partition : partitions) {
    const std::size_t local_columns = partition.ghosts + partition.count + partition.ghosts;
    for (const Pair pair : stored_pairs(method, Storage::in_place))
      partition.pairs[index(pair)] =
          AlignedArrayOf<Real>((pair == Pair::state ? local_columns : ring_columns) * layout.column_floats());
    partition.forces = AlignedArrayOf<Real>(stages_under_way * 2 * layout.force_floats());
    partition.column_rows.resize(local_columns);
    partition.pins.resize(local_columns);
    choose_rows(partition, springs);
    add_pins(partition, system);
  }
  for (std::size_t p = 0; p + 1 < partitions.size(); ++p)
    for (EdgeColumns<Real>* edge : {&partitions[p].right, &partitions[p + 1].left})
      for (AlignedArrayOf<Real>& set : edge->sets)
        set = AlignedArrayOf<Real>(partitions[p].ghosts * EdgeColumns<Real>::column_floats(layout));
}

template <class Real>
void BandGridOf<Real>::cut(std::size_t most_threads) {
  const std::size_t ghosts = ghost_columns(*this->integrator, steps_per_pass);
  const bool is_piece = layout.halves == 1;  // or all: then there are no adjacent columns
  const bool left = is_piece && own.first > 0, right = is_piece && own.end() < columns;
  const std::size_t edge_columns = ghosts * (std::size_t{left} + std::size_t{right});
  const bool has_edges = own.count >= edge_columns + narrowest_partition(*this->integrator, steps_per_pass);
  ColumnRange inner = own;
  if (has_edges && left) {
    add_partition({own.first, ghosts});
    inner = {own.first + ghosts, inner.count - ghosts};
  }
  if (has_edges && right) inner.count -= ghosts;
  first_inner = partitions.size();
  // Without edges one partition has all columns: messages bring only the first and the last ghosts.
  threads = (left || right) && !has_edges
                ? 1
                : partitions_for(inner.count, most_threads, *this->integrator, steps_per_pass);
  for (std::size_t p = 0; p < threads; ++p) add_partition(part_of(inner, p, threads));
  if (has_edges && right) add_partition({inner.end(), ghosts});
}

template <class Real>
void BandGridOf<Real>::add_partition(ColumnRange its) {
  Partition& partition = partitions.emplace_back();
  static_cast<ColumnRange&>(partition) = its;
  partition.ghosts = ghost_columns(*this->integrator, steps_per_pass);
  partition.first_of_cloth = layout.halves == 1 ? its.first : layout.halves * (its.first - own.first);
}

template <class Real>
ColumnRange BandGridOf<Real>::filled_columns(const Partition& partition) const {
  return with_ghosts(partition, partition.ghosts, columns);
}

template <class Real>
void BandGridOf<Real>::choose_rows(Partition& partition, const std::vector<SpringPerMassOf<Real>>& springs) {
  const auto to_end = [&](std::ptrdiff_t column) {
    const auto left = static_cast<std::ptrdiff_t>(layout.columns) - column;
    if (column < 0 || left < 0) return std::size_t{0};
    return std::min(static_cast<std::size_t>(left), BandRows::far_from_end);
  };
  const ColumnRange filled = filled_columns(partition);
  for (std::size_t column = filled.first; column < filled.end(); ++column) {
    ColumnsToEnd key{};
    for (std::size_t half = 0; half < layout.halves; ++half)
      key[half] = to_end(partition.cloth_column(column, half));
    partition.column_rows[partition.local(column)] =
        &band_rows.try_emplace(key, layout, springs, this->surroundings.gravity, key).first->second;
  }
}

template <class Real>
void BandGridOf<Real>::add_pins(Partition& partition, const System& system) const {
  const ColumnRange filled = filled_columns(partition);
  for (const std::uint32_t node : system.pins)
    for (std::size_t half = 0; half < layout.halves; ++half) {
      const std::size_t row = node / layout.columns;
      const std::ptrdiff_t behind =
          static_cast<std::ptrdiff_t>(node % layout.columns) - partition.cloth_column(filled.first, half);
      if (behind < 0 || static_cast<std::size_t>(behind) >= filled.count) continue;
      const Vec3<Real> position = vec3_cast<Real>(system.start.position[node]);
      partition.pins[partition.local(filled.first + static_cast<std::size_t>(behind))].push_back(
          {layout.offset(row, half), {position.x, position.y, position.z}});
    }
}

template <class Real>
void BandGridOf<Real>::fill_partition(Partition& partition, const State& state) const {
  // Above the floor, if there is one (without_floor): springs to dummies must be finite.
  constexpr double lowest_floor = -1e6;
  const double dummy_height =
      std::max(static_cast<double>(this->surroundings.floor_height), lowest_floor) + 1;
  const ColumnRange filled = filled_columns(partition);
  for (std::size_t column = filled.first; column < filled.end(); ++column) {
    Real* out = partition.column(layout, Pair::state, column) + layout.offset(0);
    for (std::size_t r = 0; r < layout.height; ++r, out += layout.row_floats())
      for (std::size_t lane = 0; lane < layout.lanes; ++lane) {
        const std::size_t row = lane % layout.bands * layout.height + r;
        const std::ptrdiff_t of_cloth = partition.cloth_column(column, lane / layout.bands);
        // Dummies keep the spacing of a cloth at rest, also from those of other pieces: springs between them
        // have no stiffness, but must not have length zero.
        Vec3d x{static_cast<double>(static_cast<std::ptrdiff_t>(first_column_) + of_cloth) * spacing_,
                dummy_height, static_cast<double>(row) * spacing_};
        Vec3d v{};
        if (row < layout.rows && of_cloth >= 0 && of_cloth < static_cast<std::ptrdiff_t>(layout.columns)) {
          const std::size_t node = row * layout.columns + static_cast<std::size_t>(of_cloth);
          x = state.position[node];
          v = dt_s_ * state.velocity[node];
        }
        write_vector(out + lane, layout.lanes, x);
        write_vector(out + 3 * layout.lanes + lane, layout.lanes, v);
      }
  }
}

template <class Real>
void BandGridOf<Real>::set_state(const State& state) {
  const auto fill = [&](std::size_t p) {
    fill_partition(partitions[p], state);
    fill_edges(p);
  };
#pragma omp parallel for num_threads(static_cast <int>(threads)) schedule(static, 1)
  for (std::size_t p = first_inner; p < first_inner + threads; ++p) fill(p);
  // The edges, which the first thread walks.
  for (std::size_t p = 0; p < partitions.size(); ++p)
    if (p < first_inner || p >= first_inner + threads) fill(p);
}

template <class Real>
void BandGridOf<Real>::fill_edges(std::size_t p) {
  Partition& partition = partitions[p];
  const auto fill = [&](EdgeColumns<Real>& edge, std::size_t first, std::size_t half) {
    for (std::size_t i = 0; i < partition.ghosts; ++i) {
      const Real* from = partition.column(layout, Pair::state, first + i) + layout.offset(0);
      Real* to = edge.column(layout, passes, i);
      for (std::size_t n = 0; n < layout.height * BandLayout::components; ++n)
        std::copy_n(from + n * layout.lanes + half * layout.bands, layout.bands, to + n * layout.bands);
    }
    edge.pass.reach(passes);
  };
  if (p > 0) fill(partition.left, partition.first, 0);
  if (p + 1 < partitions.size()) fill(partition.right, partition.end() - partition.ghosts, layout.halves - 1);
}

template <class Real>
State BandGridOf<Real>::state() const {
  return state({0, 0, static_cast<std::uint32_t>(layout.rows), static_cast<std::uint32_t>(layout.columns)});
}

template <class Real>
State BandGridOf<Real>::state(const GridWindow& window) const {
  State state;
  state.position.resize(window.nodes());
  state.velocity.resize(window.nodes());
  for (const Partition& partition : partitions)
    for (std::size_t i = 0; i < layout.halves * partition.count; ++i) {
      const std::size_t half = i / partition.count, its = partition.first + i % partition.count;
      const auto of_cloth = static_cast<std::size_t>(partition.cloth_column(its, half));
      if (of_cloth < window.column || of_cloth >= window.column + window.columns) continue;
      const Real* column = partition.column(layout, Pair::state, its);
      for (std::size_t row = 0; row < window.rows; ++row) {
        const Real* in = column + layout.offset(window.row + row, half);
        const std::size_t node = row * window.columns + of_cloth - window.column;
        state.position[node] = read_vector(in, layout.lanes);
        const Vec3d v = read_vector(in + 3 * layout.lanes, layout.lanes);
        state.velocity[node] = {v.x / dt_s_, v.y / dt_s_, v.z / dt_s_};
      }
    }
  return state;
}

template class BandRowsOf<float>;
template class BandRowsOf<double>;
template struct BandGridOf<float>;
template struct BandGridOf<double>;

}  // namespace mssim
