#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <vector>

#include "backends/interface/backend.h"
#include "backends/layouts/node_arrays.h"
#include "backends/threads/spin_wait.h"
#include "backends/threads/team_gain.h"
#include "integrators/all_integrators.h"
#include "model/system.h"

namespace mssim {

/// A cloth laid out for vectors of `lanes` numbers, floats or doubles: the rows are divided into `lanes`
/// bands of `height` rows, and lane b has band b. A row of the layout is thus `lanes` nodes that are `height`
/// rows apart, and every neighbour of a node is an aligned load of the same lane, without a shuffle or a
/// gather.
///
///     [column][row -2 .. height + 1][x y z u v w][lane]       (u v w: velocity)
///
/// The cloth may be folded: its columns are divided into halves that share the lanes, so there are lanes / 2
/// bands of twice the height. Column c of the layout is then two columns of the cloth; BandPartition defines
/// the mapping. Folding leaves fewer empty rows in a small cloth and halves the columns, each of which has a
/// fixed cost.
///
/// Two halo rows above and below have room for the neighbouring bands' rows: opencl keeps them there, openmp
/// writes them only where it reads them. Padding rows in the last bands are dummies: they stay at rest and
/// exert no force on the cloth (BandRows).
struct BandLayout {
  std::size_t lanes;
  std::size_t halves;         ///< of the columns, which share the lanes: 1 or 2
  std::size_t bands;          ///< lanes per half
  std::size_t rows, columns;  ///< of the cloth
  std::size_t height;         ///< rows per band
  std::size_t number_bytes;   ///< of a number: 4 or 8

  static constexpr std::size_t halo = 2;        ///< longest spring, in rows or columns
  static constexpr std::size_t components = 6;  ///< position and velocity

  BandLayout(const GridPatch& grid, std::size_t lane_count, std::size_t half_count = 1,
             std::size_t bytes = sizeof(float))
      : lanes(lane_count),
        halves(half_count),
        bands(lanes / halves),
        rows(grid.rows),
        columns(grid.columns),
        height(std::max(halo, (rows + bands - 1) / bands)),
        number_bytes(bytes) {}

  /// Numbers of a row of nodes and of a column.
  std::size_t row_floats() const { return components * lanes; }
  std::size_t column_floats() const { return (height + 2 * halo) * row_floats(); }
  /// Numbers from a column's start to the x of the node in a row of the cloth.
  std::size_t offset(std::size_t row, std::size_t half = 0) const {
    return (row % height + halo) * row_floats() + half * bands + row / height;
  }
  /// Numbers of one column of forces: rows 0 .. height, three components. The last row has the forces of the
  /// first row on the column's last row, one lane before.
  std::size_t force_floats() const { return (height + 1) * 3 * lanes; }
};

/// For each half of a layout's columns: the number of the cloth's columns from this one to the end, including
/// this one; 0 if it is not a column of the cloth.
using ColumnsToEnd = std::array<std::size_t, 2>;

/// Constants for the nodes of each row of a banded cloth, one value per lane: those of the springs that they
/// own, and gravity. All are zero if there is no such spring or node: then nothing pulls, dummies stay at
/// rest, and the vector code needs no masks. Most rows share their values.
template <class Real>
class BandRowsOf {
 public:
  /// The constants of a column with `to_end` columns to the end, unless it is far from the cloth's end.
  /// `springs`: by GridSpringKind. `gravity` in m/s^2, or in the springs' unit of time.
  BandRowsOf(const BandLayout& layout, const std::vector<SpringPerMassOf<Real>>& springs, Real gravity,
             ColumnsToEnd to_end = {far_from_end, far_from_end});

  /// Columns to the end beyond which springs do not reach it.
  static constexpr std::size_t far_from_end = BandLayout::halo + 1;

  /// Vectors of a row: [spring of grid_stencil][constants, stiffness_rest], then gravity.
  static constexpr std::size_t spring_vectors = spring_constant_count + 1;
  static constexpr std::size_t gravity_vector = grid_stencil.size() * spring_vectors;

  /// Values of row 0; another row's are offset_of_row() numbers later.
  const Real* values() const { return values_.data(); }
  /// Offset of row 0; those of the halo rows are before and after the rows'.
  const std::uint32_t* offset_of_row() const { return offsets_.data() + BandLayout::halo; }

 private:
  AlignedArrayOf<Real> values_;
  std::vector<std::uint32_t> offsets_;
};
using BandRows = BandRowsOf<float>;

/// Consecutive columns of a cloth.
struct ColumnRange {
  std::size_t first = 0, count = 0;
  std::size_t end() const { return first + count; }
};

/// One of `parts` parts of these columns, which differ by at most one column: the share of a process, and of
/// one of its threads.
inline ColumnRange part_of(ColumnRange all, std::size_t part, std::size_t parts) {
  const std::size_t begin = all.count * part / parts, end = all.count * (part + 1) / parts;
  return {all.first + begin, end - begin};
}

/// These columns and up to `ghosts` adjacent ones on each side, within a cloth of `columns`.
inline ColumnRange with_ghosts(ColumnRange own, std::size_t ghosts, std::size_t columns) {
  const std::size_t begin = own.first - std::min(own.first, ghosts);
  return {begin, std::min(own.end() + ghosts, columns) - begin};
}

/// Stages active at the same time. Each follows the previous one at a distance of two columns, so it gathers
/// what has just been written, and the data between them are a few columns, which stay in a cache: a step of
/// RK4 moves the state through memory once instead of four times, and steps of few stages are passed several
/// at a time.
inline constexpr std::size_t stages_under_way = 4;
static_assert(max_stages <= stages_under_way);

/// Columns on each side of a partition that a pass of `steps_per_pass` steps needs.
inline std::size_t ghost_columns(const Integrator& integrator, std::size_t steps_per_pass) {
  return BandLayout::halo * integrator.stage_count * steps_per_pass;
}

/// The most steps per pass, at most `steps`, of which the narrowest piece of a cloth has the ghosts: a piece
/// receives them from the adjacent pieces only.
inline std::size_t steps_within(std::size_t steps, const Integrator& integrator, std::size_t narrowest) {
  while (steps > 1 && ghost_columns(integrator, steps) > narrowest) --steps;
  return steps;
}

/// How a banded cloth is divided, if not by its size.
struct BandCut {
  std::optional<std::size_t> steps_per_pass{};  ///< the total of their stages is at most stages_under_way
  /// The columns that a piece owns; of the others it needs ghost_columns on each side, or none at the end of
  /// the cloth. A piece is not folded.
  std::optional<ColumnRange> piece{};
  std::optional<std::size_t> halves{};  ///< BandLayout::halves
};

/// Best number of partitions for `columns` columns of a layout, at most `threads`.
std::size_t partitions_for(std::size_t columns, std::size_t threads, const Integrator& integrator,
                           std::size_t steps_per_pass);

/// Best number of steps per pass over a cloth of that layout, with this number of partitions.
std::size_t steps_per_pass_for(const BandLayout& layout, const Integrator& integrator,
                               std::size_t partitions);

/// A CPU's costs of columns in passes of one stage, which decide whether to fold a cloth.
struct ColumnCosts {
  double rows_beside;    ///< fixed cost of a column, in rows
  double clearly_fewer;  ///< a fold pays if it reduces the rows to this fraction
  std::size_t bytes;     ///< available for active columns

  /// Costs on this CPU.
  static ColumnCosts here();
};

/// Best number of halves for a cloth of that layout, which has one, with this number of threads.
std::size_t halves_for(const BandLayout& layout, const Integrator& integrator, std::size_t steps_per_pass,
                       std::size_t threads, const ColumnCosts& of_one_stage = ColumnCosts::here());

/// Exchange of the edge columns of a piece with the processes that step the adjacent columns: the counterpart
/// between processes of the copies between threads.
class ColumnMessages {
 public:
  ColumnMessages() = default;
  ColumnMessages(const ColumnMessages&) = delete;
  ColumnMessages& operator=(const ColumnMessages&) = delete;
  virtual ~ColumnMessages() = default;

  /// Starts to send the edge columns, which are complete for the next pass. The ghosts next to them must not
  /// be read before finish(). Does not wait.
  virtual void begin() = 0;
  /// Lets messages progress. Does not wait.
  virtual void advance() = 0;
  /// Waits until the ghosts are the neighbours' columns of the next pass and the own edge columns may change
  /// again. Must not throw, like the other functions: threads of a step call them.
  virtual void finish() = 0;
};

/// Columns between the first active stage and those that the last one still gathers, and so the columns that
/// a trial pair keeps, as a ring.
inline constexpr std::size_t ring_columns = std::bit_ceil(BandLayout::halo * stages_under_way);

/// Columns at one end of a partition, for the adjacent partition: copies, because the walk overwrites the
/// state. Two alternating sets, so that a thread that is one pass behind still finds the data of its pass:
/// threads need no barrier.
template <class Real>
struct EdgeColumns {
  /// [pass % 2][ghosts][height][x y z u v w][lane of a half]: without halo rows, and without the half that no
  /// other thread reads, to move less between caches.
  std::array<AlignedArrayOf<Real>, 2> sets;
  ThreadProgress pass;  ///< the next pass that may read its set

  bool exists() const { return sets[0].size() > 0; }  ///< whether there is a partition that reads them
  static std::size_t column_floats(const BandLayout& layout) {
    return layout.height * BandLayout::components * layout.bands;
  }
  Real* column(const BandLayout& layout, std::uint64_t of_pass, std::size_t number) {
    return sets[of_pass % 2].data() + number * column_floats(layout);
  }
};

/// The columns of one thread, numbered as in the layout, with ghost columns on each side that repeat the
/// neighbours': two for each active stage. The thread recomputes there all stages except the last, so it
/// needs no other thread until the last is done.
template <class Real>
struct BandPartitionOf : ColumnRange {
  std::size_t first_of_cloth = 0;  ///< column of the cloth that `first` is in the first half
  std::size_t ghosts = 0;          ///< on each side
  /// The state [ghosts + count + ghosts][column_floats], other pairs [ring_columns][column_floats]; empty if
  /// not stored.
  std::array<AlignedArrayOf<Real>, pair_kinds> pairs;
  std::vector<std::vector<PlacedPin<Real>>> pins;    ///< [ghosts + count + ghosts] by column
  std::vector<const BandRowsOf<Real>*> column_rows;  ///< by column: constants of its rows
  AlignedArrayOf<Real> forces;                       ///< [stages_under_way][2][force_floats], active columns
  /// Its first `ghosts` columns for the partition before it and its last ones for the next; empty if there is
  /// none.
  EdgeColumns<Real> left, right;

  /// Index of a column in `pins` and in the state; first - ghosts <= column.
  std::size_t local(std::size_t column) const { return column + ghosts - first; }
  /// The cloth's column for a column of the layout in a half; may be outside the cloth. The halves of a
  /// partition are contiguous.
  std::ptrdiff_t cloth_column(std::size_t column, std::size_t half) const {
    return static_cast<std::ptrdiff_t>(first_of_cloth + column + half * count) -
           static_cast<std::ptrdiff_t>(first);
  }
  Real* column(const BandLayout& layout, Pair stored, std::size_t column) {
    return pairs[index(stored)].data() + offset(layout, stored, column);
  }
  const Real* column(const BandLayout& layout, Pair stored, std::size_t column) const {
    return pairs[index(stored)].data() + offset(layout, stored, column);
  }

 private:
  std::size_t offset(const BandLayout& layout, Pair stored, std::size_t column) const {
    return (stored == Pair::state ? local(column) : column % ring_columns) * layout.column_floats();
  }
};
using BandPartition = BandPartitionOf<float>;

/// Data that the vector code needs to step a cloth. The unit of time is a step: velocities are in m per step,
/// so a displacement is added without a multiplication.
///
/// The cloth may be a piece of a larger one, whose other columns other processes step: it owns some columns,
/// and the adjacent ones are ghosts, which messages bring. Columns for other processes are walked first: the
/// edge columns of a wide piece are partitions of their own.
template <class Real>
struct BandGridOf : ExplicitSteps<Real> {
  BandLayout layout;
  std::map<ColumnsToEnd, BandRowsOf<Real>> band_rows;
  std::size_t steps_per_pass = 1;  ///< steps active at once
  /// Columns of the layout: those of the cloth; if it is folded, those of a half, with ghosts at both ends.
  /// There the halves continue across the cut, and beyond the cloth's ends are dummies.
  std::size_t columns = 0;
  ColumnRange own;  ///< those of them that the partitions cover: of the piece, or of a half
  std::deque<BandPartitionOf<Real>> partitions;  ///< in the order of their columns
  std::size_t first_inner = 0;                   ///< earlier partitions are an edge
  std::size_t threads = 0;   ///< number of inner partitions, with a thread each; the rest are an edge
  std::uint64_t passes = 0;  ///< so far
  ColumnMessages* messages = nullptr;  ///< of a piece; must outlive the steps
  TeamGain team_gain;                  ///< for one thread per inner partition

  /// Divides the cloth for `lanes` lanes and at most `most_threads` inner partitions. Arrays are untouched
  /// until set_state.
  BandGridOf(const System& system, const GridPatch& grid, const Integrator& method, double dt_s,
             std::size_t lanes, std::size_t most_threads, const BandCut& given = {});
  /// Distributes the state over the partitions, including ghosts and dummies; each thread writes its own.
  void set_state(const State& state);
  State state() const;
  /// The state of the nodes of a window, whose columns it must own.
  State state(const GridWindow& window) const;

 private:
  using Partition = BandPartitionOf<Real>;
  double dt_s_ = 0;
  double spacing_ = 0;  ///< m, for the positions of dummies, with the next
  std::size_t first_column_ = 0;
  void cut(std::size_t most_threads);
  void add_partition(ColumnRange its);
  void choose_rows(Partition& partition, const std::vector<SpringPerMassOf<Real>>& springs);
  void add_pins(Partition& partition, const System& system) const;
  /// The columns of a partition to fill: own ones and ghosts within the layout.
  ColumnRange filled_columns(const Partition& partition) const;
  /// Copies the state's columns for the neighbours of a partition.
  void fill_edges(std::size_t p);
  void fill_partition(Partition& partition, const State& state) const;
};
using BandGrid = BandGridOf<float>;

}  // namespace mssim
