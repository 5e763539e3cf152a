#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <vector>

#include "backends/interface/backend.h"
#include "backends/layouts/aligned_array.h"
#include "backends/layouts/band_cut.h"
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

/// Columns behind the first stage that the last one under way still gathers from, and so the columns that a
/// trial pair keeps: they are used in turn.
inline constexpr std::size_t ring_columns = std::bit_ceil(BandLayout::halo * stages_under_way);

/// The columns at one end of a partition, as the partition beside it reads them: copies, because the walk
/// writes over the state. Two sets, used in turn, so that a thread that is a pass behind still finds those of
/// its pass: threads need not meet.
struct EdgeColumns {
  /// [pass % 2][ghosts][height][x y z u v w][lane of a half]: without room for halo rows, and without the
  /// half that nobody else reads, for less to move between caches.
  std::array<AlignedArray, 2> sets;
  ThreadProgress pass;  ///< the next pass that may read its set

  bool exists() const { return sets[0].size() > 0; }  ///< whether there is a partition to read them
  static std::size_t column_floats(const BandLayout& layout) {
    return layout.height * BandLayout::components * layout.bands;
  }
  float* column(const BandLayout& layout, std::uint64_t of_pass, std::size_t number) {
    return sets[of_pass % 2].data() + number * column_floats(layout);
  }
};

/// The columns of one thread, numbered as in the layout, and on each side ghost columns that repeat the
/// neighbours': two for each stage under way. The thread computes what stages but the last do there a second
/// time, and so needs nobody until the last is through.
struct BandPartition {
  std::size_t first = 0;
  std::size_t count = 0;           ///< columns that are the thread's own
  std::size_t first_of_cloth = 0;  ///< column of the cloth that `first` is in the first half
  std::size_t ghosts = 0;          ///< on each side
  /// The state [ghosts + count + ghosts][column_floats], other pairs [ring_columns][column_floats]; empty
  /// where not stored.
  std::array<AlignedArray, pair_kinds> pairs;
  std::vector<std::vector<BandPin>> pins;    ///< [ghosts + count + ghosts] by column
  std::vector<const BandRows*> column_rows;  ///< the same: what the rows of a column compute with
  AlignedArray forces;                       ///< [stages_under_way][2][force_floats], columns under way
  /// Its first `ghosts` columns for the partition before it and its last ones for the one behind; empty where
  /// there is none.
  EdgeColumns left, right;

  /// Place of a column in `pins` and in the state; first - ghosts <= column.
  std::size_t local(std::size_t column) const { return column + ghosts - first; }
  /// The column of the cloth that one of the layout is in a half; may lie beside the cloth. The halves of a
  /// partition follow each other.
  std::ptrdiff_t cloth_column(std::size_t column, std::size_t half) const {
    return static_cast<std::ptrdiff_t>(first_of_cloth + column + half * count) -
           static_cast<std::ptrdiff_t>(first);
  }
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
  std::map<ColumnsToEnd, BandRows> band_rows;
  std::size_t steps_per_pass = 1;  ///< steps under way at once
  /// Columns of the layout. Those of the cloth; if it is folded, those of a half and ghosts at both ends, in
  /// which the halves go on where they were cut, and behind the cloth's ends are dummies.
  std::size_t columns = 0;
  ColumnRange own;  ///< of them, what the partitions cover: those of the piece, or of a half
  std::deque<BandPartition> partitions;  ///< in the order of their columns
  std::size_t first_inner = 0;           ///< partitions before this one are an edge
  std::size_t threads = 0;               ///< partitions from there on that have a thread each; then an edge
  std::uint64_t passes = 0;              ///< taken so far
  ColumnMessages* messages = nullptr;    ///< of a piece; outlives the steps
  TeamGain team_gain;                    ///< of a thread for each inner partition

  /// Cuts the cloth for `lanes` lanes and at most `most_threads` inner partitions. Arrays stay untouched
  /// until set_state.
  BandGrid(const System& system, const GridPatch& grid, const Integrator& method, double dt_s,
           std::size_t lanes, std::size_t most_threads, const BandCut& given = {});
  /// Spreads the state over the partitions, each by a thread of its own, ghosts and dummies included.
  void set_state(const State& state);
  State state() const;
  /// That of the nodes of a window, whose columns it owns.
  State state(const GridWindow& window) const;

 private:
  double spacing_ = 0;  ///< m, places the dummies, with the next
  std::size_t first_column_ = 0;
  void cut(std::size_t most_threads);
  void add_partition(ColumnRange its);
  void make_arrays(BandPartition& partition) const;
  void choose_rows(BandPartition& partition, const std::vector<SpringConstants>& springs);
  void add_pins(BandPartition& partition, const System& system) const;
  /// The columns of a partition that are filled: own ones and ghosts, where the layout has them.
  ColumnRange filled_columns(const BandPartition& partition) const;
  /// Copies the state's columns to those that others read.
  void fill_edges(std::size_t p);
  void fill_partition(BandPartition& partition, const State& state) const;
};

}  // namespace mssim
