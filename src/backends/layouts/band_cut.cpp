#include "backends/layouts/band_cut.h"

#include <unistd.h>

#include <algorithm>

namespace mssim {
namespace {

constexpr std::size_t halo = BandLayout::halo;

/// Bytes of a cache, by its name to sysconf; `usual` where the system does not say.
std::size_t cache_bytes(int name, long usual) {
  const long found = sysconf(name);
  return static_cast<std::size_t>(found > 0 ? found : usual);
}

/// Rows that a pass over one of the partitions walks through, as many as take its time.
double rows_of_pass(const BandLayout& layout, const Integrator& integrator, std::size_t steps_per_pass,
                    std::size_t threads) {
  // Measured on an Intel Xeon: what a column takes beside its rows; and, rounded up, what one takes whose
  // nodes are not updated, with the copies that it is read from.
  constexpr double rows_beside = 0.7, partial_column = 0.8;
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

}  // namespace

std::size_t narrowest_partition(const Integrator& integrator, std::size_t steps_per_pass) {
  return std::max(2 * halo * integrator.stage_count, ghost_columns(integrator, steps_per_pass));
}

std::size_t partitions_for(std::size_t columns, std::size_t threads, const Integrator& integrator,
                           std::size_t steps_per_pass) {
  const std::size_t most = columns / narrowest_partition(integrator, steps_per_pass);
  return std::clamp<std::size_t>(threads, 1, std::max<std::size_t>(1, most));
}

/// A state that the last-level cache holds (the half of it that one may count on) is best left there: more
/// columns under way than the first-level cache holds cost 4 to 12 % at 350,000 nodes. From memory, as many
/// as there is room for among the stages under way: semi-euler was 1.9 times as fast with four at a million
/// nodes and 1.8 times with columns of 4,000 rows. Ghost columns must stay a small share.
std::size_t steps_per_pass_for(const BandLayout& layout, const Integrator& integrator,
                               std::size_t partitions) {
  constexpr std::size_t columns_per_stage = 16;
  const std::size_t cache = cache_bytes(_SC_LEVEL3_CACHE_SIZE, 16L << 20);
  const std::size_t steps = stages_under_way / integrator.stage_count;
  const bool fits = layout.columns * layout.column_floats() * sizeof(float) <= cache / 2;
  const bool narrow =
      partitions > 1 && layout.columns / partitions < columns_per_stage * steps * integrator.stage_count;
  return fits || narrow ? 1 : steps;
}

/// Folded where that leaves fewer rows to walk through, clearly, and where the first-level cache holds the
/// columns under way: three of the state and two of forces.
std::size_t halves_for(const BandLayout& layout, const Integrator& integrator, std::size_t steps_per_pass,
                       std::size_t threads) {
  constexpr double clearly_fewer = 0.97;
  if (layout.lanes < 2) return 1;
  const BandLayout folded(
      {static_cast<std::uint32_t>(layout.rows), static_cast<std::uint32_t>(layout.columns)}, layout.lanes, 2);
  const std::size_t under_way = (3 * folded.column_floats() + 2 * folded.force_floats()) * sizeof(float);
  if (under_way > cache_bytes(_SC_LEVEL1_DCACHE_SIZE, 32L << 10)) return 1;
  return rows_of_pass(folded, integrator, steps_per_pass, threads) <
                 clearly_fewer * rows_of_pass(layout, integrator, steps_per_pass, threads)
             ? 2
             : 1;
}

}  // namespace mssim
