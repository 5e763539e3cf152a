#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "backends/interface/surroundings.h"
#include "backends/layouts/aligned_array.h"
#include "backends/layouts/band_layout.h"
#include "backends/layouts/band_rows.h"
#include "backends/layouts/column_messages.h"
#include "backends/layouts/column_range.h"
#include "backends/threads/team_gain.h"
#include "backends/threads/thread_progress.h"
#include "integrators/coefficients.h"
#include "model/system.h"

namespace mssim {

/// A node that must be put back after every update.
struct BandPin {
  std::size_t offset;  ///< floats from the column's start to the node's x
  std::array<float, 3> position;
};

/// Stages under way at once. Each walks two columns behind the one before it, so that what it gathers has
/// just been written, and all that lives between them are a few columns, which stay in a cache: a step of RK4
/// moves the state through memory once instead of four times, and steps of few stages go through it several
/// at a time. Measured at 500 x 700 on two cores, RK4: stage by stage 9 to 12 times as fast as the spring
/// list, like this 27 times.
inline constexpr std::size_t stages_under_way = 4;
static_assert(max_stages <= stages_under_way);

/// Columns behind the first stage that the last one under way still gathers from, and so the columns that a
/// trial pair keeps: they are used in turn.
inline constexpr std::size_t ring_columns = std::bit_ceil(BandLayout::halo * stages_under_way);

/// Columns beside those of a partition that a pass of so many steps needs.
inline std::size_t ghost_columns(const Integrator& integrator, std::size_t steps_per_pass) {
  return BandLayout::halo * integrator.stage_count * steps_per_pass;
}

/// Steps that a pass had best take over a cloth of that layout and so many partitions.
std::size_t steps_per_pass_for(const BandLayout& layout, const Integrator& integrator,
                               std::size_t partitions);

/// The columns at one end of a partition, as the partition beside it reads them: copies, because the walk
/// writes over the state. Two sets, used in turn, so that a thread that is a pass behind still finds those of
/// its pass: threads need not meet.
struct EdgeColumns {
  /// [pass % 2][ghosts][height][x y z u v w][lane]: without room for halo rows, for less to move between
  /// caches.
  std::array<AlignedArray, 2> sets;
  ThreadProgress pass;  ///< the next pass that may read its set

  bool exists() const { return sets[0].size() > 0; }  ///< whether there is a partition to read them
  static std::size_t column_floats(const BandLayout& layout) { return layout.height * layout.row_floats(); }
  float* column(const BandLayout& layout, std::uint64_t of_pass, std::size_t number) {
    return sets[of_pass % 2].data() + number * column_floats(layout);
  }
};

/// The columns of one thread, and on each side ghost columns that repeat the neighbours': two for each stage
/// under way. The thread computes what stages but the last do there a second time, and so needs nobody until
/// the last is through.
struct BandPartition {
  std::size_t first = 0;   ///< column of the cloth
  std::size_t count = 0;   ///< columns that are the thread's own
  std::size_t ghosts = 0;  ///< on each side
  /// The state [ghosts + count + ghosts][column_floats], other pairs [ring_columns][column_floats]; empty
  /// where not stored.
  std::array<AlignedArray, pair_kinds> pairs;
  std::vector<std::vector<BandPin>> pins;  ///< [ghosts + count + ghosts] by column
  AlignedArray forces;                     ///< [stages_under_way][3][force_floats], columns under way
  /// Its first `ghosts` columns for the partition before it and its last ones for the one behind; empty where
  /// there is none.
  EdgeColumns left, right;

  /// Place of a column of the cloth in `pins` and in the state; first - ghosts <= column.
  std::size_t local(std::size_t column) const { return column + ghosts - first; }
  float* column(const BandLayout& layout, Pair stored, std::size_t column) {
    return pairs[index(stored)].data() + offset(layout, stored, column);
  }
  const float* column(const BandLayout& layout, Pair stored, std::size_t column) const {
    return pairs[index(stored)].data() + offset(layout, stored, column);
  }

 private:
  std::size_t offset(const BandLayout& layout, Pair stored, std::size_t column) const {
    return (stored == Pair::state ? local(column) : column % ring_columns) * layout.column_floats();
  }
};

/// What the vector code needs to take steps: one cloth, one integrator, one dt.
///
/// The cloth may be a piece of a larger one, whose other columns other processes step: it owns some of its
/// columns, and those beside them are ghosts, which messages bring. What the others wait for is walked first:
/// of a wide piece, the columns at its ends are partitions of their own.
struct BandGrid {
  BandLayout layout;
  const Integrator* integrator = nullptr;
  Coefficients<float> coefficients{};
  Surroundings surroundings{};
  BandRows band_rows;
  std::size_t steps_per_pass = 1;        ///< steps under way at once
  std::deque<BandPartition> partitions;  ///< in the order of their columns; of two or more, each has `ghosts`
  ColumnRange own;                       ///< what the partitions cover: all columns, or those of the piece
  std::size_t first_inner = 0;           ///< partitions before this one are an edge
  std::size_t inner_count = 0;           ///< partitions from there on that have a thread each; then an edge
  std::uint64_t passes = 0;              ///< taken so far
  ColumnMessages* messages = nullptr;    ///< of a piece; outlives the steps
  TeamGain team_gain;                    ///< of a thread for each inner partition

  /// Cuts the cloth for `lanes` lanes and at most `threads` partitions. Arrays stay untouched until
  /// set_state. `steps_in_a_pass`: chosen by the size of the cloth unless given; their stages must not be
  /// more than stages_under_way. `piece`: the columns that it owns, unless all; of the others there must be
  /// ghost_columns on each side, or none where the cloth ends.
  BandGrid(const System& system, const GridPatch& grid, const Integrator& method, double dt_s,
           std::size_t lanes, std::size_t threads, std::optional<std::size_t> steps_in_a_pass = {},
           std::optional<ColumnRange> piece = {});
  /// Spreads the state over the partitions, each by a thread of its own, ghosts and dummies included.
  void set_state(const State& state);
  State state() const;
  /// That of the nodes of a window, whose columns it owns.
  State state(const GridWindow& window) const;

 private:
  double spacing_ = 0;  ///< m, places the dummies, with the next
  std::size_t first_column_ = 0;
  void cut(std::size_t threads);
  /// Copies the state's columns to those that others read.
  void fill_edges(std::size_t p);
  void fill_partition(BandPartition& partition, const State& state) const;
};

}  // namespace mssim
