#pragma once

#include <cstddef>
#include <optional>

#include "backends/layouts/band_layout.h"
#include "backends/layouts/column_range.h"
#include "integrators/integrators.h"

namespace mssim {

/// Stages under way at once. Each walks two columns behind the one before it, so that what it gathers has
/// just been written, and all that lives between them are a few columns, which stay in a cache: a step of RK4
/// moves the state through memory once instead of four times, and steps of few stages go through it several
/// at a time. Measured at 500 x 700 on two cores, RK4: stage by stage 9 to 12 times as fast as the spring
/// list, like this 27 times.
inline constexpr std::size_t stages_under_way = 4;
static_assert(max_stages <= stages_under_way);

/// Columns beside those of a partition that a pass of so many steps needs.
inline std::size_t ghost_columns(const Integrator& integrator, std::size_t steps_per_pass) {
  return BandLayout::halo * integrator.stage_count * steps_per_pass;
}

/// How a cloth in bands is cut, where that is not chosen by its size.
struct BandCut {
  std::optional<std::size_t> steps_per_pass{};  ///< their stages must not be more than stages_under_way
  /// The columns that a piece owns; of the others there must be ghost_columns on each side, or none where the
  /// cloth ends. A piece is not folded.
  std::optional<ColumnRange> piece{};
  std::optional<std::size_t> halves{};  ///< BandLayout::halves
};

/// Columns of the narrowest partition. Threads recompute two columns a stage and side; a partition narrower
/// than this would be mostly that. Its ghosts belong to the partitions beside it.
std::size_t narrowest_partition(const Integrator& integrator, std::size_t steps_per_pass);

/// Partitions that so many columns of a layout had best have, of `threads` at most.
std::size_t partitions_for(std::size_t columns, std::size_t threads, const Integrator& integrator,
                           std::size_t steps_per_pass);

/// Steps that a pass had best take over a cloth of that layout and so many partitions.
std::size_t steps_per_pass_for(const BandLayout& layout, const Integrator& integrator,
                               std::size_t partitions);

/// Halves in which a cloth of that layout, which has one, had best be walked over by so many threads.
std::size_t halves_for(const BandLayout& layout, const Integrator& integrator, std::size_t steps_per_pass,
                       std::size_t threads);

}  // namespace mssim
