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

/// A cloth laid out for vectors of `lanes` floats: the rows are cut into `lanes` bands of `height` rows, and
/// lane b holds band b. A row of the layout is thus `lanes` nodes that lie `height` rows apart, and every
/// neighbour of a node is an aligned load of the same lane, without a shuffle or a gather.
///
///     [column][row -2 .. height + 1][x y z u v w][lane]       (u v w: velocity)
///
/// The cloth may be folded: its columns are cut into halves that lie side by side in the lanes, so that there
/// are lanes / 2 bands, twice as high. Column c of the layout is then two columns of the cloth; which ones,
/// who walks over them says (BandPartition). A small cloth leaves fewer rows empty so, and columns are half
/// as many, each of which takes some time beside its rows.
///
/// Two halo rows above and below are room for the neighbouring bands' rows: opencl keeps them there, openmp
/// puts them there only where it reads them. Rows that the last bands have too many are dummies: they stay at
/// rest and no force from them reaches a node of the cloth (BandRows).
struct BandLayout {
  std::size_t lanes;
  std::size_t halves;         ///< of the columns, side by side in the lanes: 1 or 2
  std::size_t bands;          ///< lanes of a half
  std::size_t rows, columns;  ///< of the cloth
  std::size_t height;         ///< rows in a band

  static constexpr std::size_t halo = 2;        ///< longest spring, in rows or columns
  static constexpr std::size_t components = 6;  ///< position and velocity

  BandLayout(const GridPatch& grid, std::size_t lane_count, std::size_t half_count = 1)
      : lanes(lane_count),
        halves(half_count),
        bands(lanes / halves),
        rows(grid.rows),
        columns(grid.columns),
        height(std::max(halo, (rows + bands - 1) / bands)) {}

  std::size_t row_floats() const { return components * lanes; }
  std::size_t column_floats() const { return (height + 2 * halo) * row_floats(); }
  /// Floats from a column's start to the x of the node in a row of the cloth.
  std::size_t offset(std::size_t row, std::size_t half = 0) const {
    return (row % height + halo) * row_floats() + half * bands + row / height;
  }
  /// Floats of one column of forces: rows 0 .. height, three components. The last row holds what
  /// the first row gives to the column's last row, a lane before.
  std::size_t force_floats() const { return (height + 1) * 3 * lanes; }
};

/// For each half of a layout's columns, how many columns of the cloth there are from one of them to the
/// cloth's end, itself included; 0 if it is none of the cloth's.
using ColumnsToEnd = std::array<std::size_t, 2>;

/// What the nodes of each row of a banded cloth compute with, one value a lane: the constants of the springs
/// that they own, and gravity. All are zero where there is no such spring, or no node: then nothing pulls,
/// dummies stay at rest, and the vector code needs no masks. Most rows share their values.
class BandRows {
 public:
  /// The constants of a column that so many are `behind`, unless it is far from the cloth's end. `springs`:
  /// by GridSpringKind. `gravity` in m/s^2, or in the unit of time of the springs.
  BandRows(const BandLayout& layout, const std::vector<SpringPerMass>& springs, float gravity,
           ColumnsToEnd to_end = {far_from_end, far_from_end});

  /// Columns to the end beyond which springs reach no further.
  static constexpr std::size_t far_from_end = BandLayout::halo + 1;

  /// Vectors of a row: [spring of grid_stencil][constants, stiffness_rest], then gravity.
  static constexpr std::size_t spring_vectors = spring_constant_count + 1;
  static constexpr std::size_t gravity_vector = grid_stencil.size() * spring_vectors;

  /// Those of row 0; the others' are offset_of_row() floats behind.
  const float* values() const { return values_.data(); }
  /// Row 0's; those of halo rows stand before and behind the rows'.
  const std::uint32_t* offset_of_row() const { return offsets_.data() + BandLayout::halo; }

 private:
  AlignedArray values_;
  std::vector<std::uint32_t> offsets_;
};

/// Columns of a cloth that follow each other.
struct ColumnRange {
  std::size_t first = 0, count = 0;
  std::size_t end() const { return first + count; }
};

/// One of `parts` parts of these columns, which differ by at most one column: what a process of several takes
/// of a cloth, and a thread of that.
inline ColumnRange part_of(ColumnRange all, std::size_t part, std::size_t parts) {
  const std::size_t begin = all.count * part / parts, end = all.count * (part + 1) / parts;
  return {all.first + begin, end - begin};
}

/// These columns, and beside them so many of the others that a cloth of `columns` has.
inline ColumnRange with_ghosts(ColumnRange own, std::size_t ghosts, std::size_t columns) {
  const std::size_t begin = own.first - std::min(own.first, ghosts);
  return {begin, std::min(own.end() + ghosts, columns) - begin};
}

/// Stages under way at once. Each walks two columns behind the one before it, so that what it gathers has
/// just been written, and all that lives between them are a few columns, which stay in a cache: a step of RK4
/// moves the state through memory once instead of four times, and steps of few stages go through it several
/// at a time.
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

/// Partitions that so many columns of a layout had best have, of `threads` at most.
std::size_t partitions_for(std::size_t columns, std::size_t threads, const Integrator& integrator,
                           std::size_t steps_per_pass);

/// Steps that a pass had best take over a cloth of that layout and so many partitions.
std::size_t steps_per_pass_for(const BandLayout& layout, const Integrator& integrator,
                               std::size_t partitions);

/// What a processor takes for columns where a pass has one stage, on which depends whether a cloth had best
/// be folded.
struct ColumnCosts {
  double rows_beside;    ///< a column takes the time of so many rows beside its own
  double clearly_fewer;  ///< a fold that leaves this share of the rows pays
  std::size_t bytes;     ///< so much may be under way

  /// Those of this processor.
  static ColumnCosts here();
};

/// Halves in which a cloth of that layout, which has one, had best be walked over by so many threads.
std::size_t halves_for(const BandLayout& layout, const Integrator& integrator, std::size_t steps_per_pass,
                       std::size_t threads, const ColumnCosts& of_one_stage = ColumnCosts::here());

/// How the columns of a cloth at the ends of a piece reach the processes that step the columns beside it, and
/// theirs this one: what a copy between the threads of a process is, between processes.
class ColumnMessages {
 public:
  ColumnMessages() = default;
  ColumnMessages(const ColumnMessages&) = delete;
  ColumnMessages& operator=(const ColumnMessages&) = delete;
  virtual ~ColumnMessages() = default;

  /// The columns at the ends are those of the next pass, and nothing reads the ghosts beside them any more
  /// before finish(). Does not wait.
  virtual void begin() = 0;
  /// Lets messages that are under way go on. Does not wait.
  virtual void advance() = 0;
  /// Waits until the ghosts are the neighbours' columns of the next pass, and the own ones may change again.
  /// Throws nothing, like the others: threads of a step call them.
  virtual void finish() = 0;
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
  std::vector<std::vector<PlacedPin>> pins;  ///< [ghosts + count + ghosts] by column
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

/// What the vector code needs to take steps of a cloth. The unit of time is a step: velocities are in m a
/// step, and what a node moves in a step is added without a multiplication.
///
/// The cloth may be a piece of a larger one, whose other columns other processes step: it owns some of its
/// columns, and those beside them are ghosts, which messages bring. What the others wait for is walked first:
/// of a wide piece, the columns at its ends are partitions of their own.
struct BandGrid : ExplicitSteps {
  BandLayout layout;
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
  double dt_s_ = 0;
  double spacing_ = 0;  ///< m, places the dummies, with the next
  std::size_t first_column_ = 0;
  void cut(std::size_t most_threads);
  void add_partition(ColumnRange its);
  void choose_rows(BandPartition& partition, const std::vector<SpringPerMass>& springs);
  void add_pins(BandPartition& partition, const System& system) const;
  /// The columns of a partition that are filled: own ones and ghosts, where the layout has them.
  ColumnRange filled_columns(const BandPartition& partition) const;
  /// Copies the state's columns to those that others read.
  void fill_edges(std::size_t p);
  void fill_partition(BandPartition& partition, const State& state) const;
};

}  // namespace mssim
