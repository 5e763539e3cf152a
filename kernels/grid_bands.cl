/* The walk over a grid if a work-item has several lanes, which suits a CPU. The code of a stage in a column
 * and the kernel that takes steps are generated from the table of integrators
 * (src/backends/opencl/programs.cpp) and follow this text.
 *
 * The layout is that of BandLayout (src/backends/layouts/band_grid.h) with MSSIM_LANES bands, whose halo rows
 * repeat rows of the neighbouring bands.
 *
 * A work-item walks over its columns from the left, down the rows in each, and computes every spring once, at
 * its left or upper end. The force on the other end is kept: in registers for the rows below, in `sums` for
 * the next two columns. The walk includes the two columns left of the work-item's own, because of their
 * forces on its columns.
 *
 * No spring points to an earlier column, so a stage may overwrite what it gathers from. The stages of a
 * launch follow each other at a distance of two columns: a stage gathers what has just been written, and the
 * trial pairs, which live between stages, are kept in rings of a few columns. One pass over the state takes
 * all steps of a launch.
 *
 * Work-items do not wait for each other. The columns of neighbours that a stage needs are computed twice: two
 * columns for every later stage, from ghosts that repeat the neighbours' state before the launch. Each
 * work-item writes its columns as ghosts for its neighbours' next launch, to other memory than the ghosts
 * that they read in this one.
 */
#define row_floats (6 * MSSIM_LANES)

typedef MSSIM_PASTE(uint, MSSIM_LANES) Rows;

/* Location of MSSIM_LANES nodes, one in each band. */
typedef struct {
  size_t first; /* offset from row 0 of the column */
  Mask free;    /* nodes of the cloth that are not pinned */
} Tile;

static inline size_t column_floats(Shape grid) { return (size_t)(grid->height + 4) * row_floats; }
#define halo 2 /* rows or columns that a spring reaches */

/* The columns of a work-item. */
typedef struct {
  int number, count; /* this partition's number, and the number of partitions */
  int first, end;    /* columns; at least two */
} Partition;
static inline Partition partition_of(int number, int count, Shape grid) {
  Partition partition = {number, count, (int)((long)grid->columns * number / count),
                         (int)((long)grid->columns * (number + 1) / count)};
  return partition;
}

/* A column of the ghosts of a partition, which are [column first - grid->ghosts .. first - 1,
 * end .. end + grid->ghosts - 1]. */
static inline __global float* ghost(__global float* ghosts, int partition, int number, Shape grid) {
  return ghosts + (size_t)(2 * grid->ghosts * partition + number) * column_floats(grid);
}

/* Memory of a work-item. */
typedef struct {
  Partition partition;
  __global float* state;
  __global float *ghosts, *next_ghosts; /* of all partitions, for this launch and for the next one */
  __global float* rings; /* of this partition: [pair][column % grid->ring], columns as the state's */
  __global float* sums;  /* of this partition: [stage of the launch][column % 3][row][x y z][lane] */
} Walk;

static inline size_t sums_floats(Shape grid) { return (size_t)grid->height * 3 * MSSIM_LANES; }

static inline Walk walk_of(int number, int count, int swapped, int ring_pairs, __global float* state,
                           __global float* ghosts, __global float* rings, __global float* sums, Shape grid) {
  __global float* second_ghosts = ghost(ghosts, count, 0, grid);
  Walk walk = {partition_of(number, count, grid),
               state,
               swapped ? second_ghosts : ghosts,
               swapped ? ghosts : second_ghosts,
               rings + (size_t)number * ring_pairs * grid->ring * column_floats(grid),
               sums + (size_t)number * grid->ghosts / halo * 3 * sums_floats(grid)};
  return walk;
}

/* Row 0 of a column of the state, wherever the partition stores it. */
static inline __global float* state_column(int column, const Walk* walk, Shape grid) {
  const Partition* partition = &walk->partition;
  __global float* start;
  if (column < partition->first)
    start = ghost(walk->ghosts, partition->number, column - partition->first + grid->ghosts, grid);
  else if (column >= partition->end)
    start = ghost(walk->ghosts, partition->number, column - partition->end + grid->ghosts, grid);
  else
    start = walk->state + column * column_floats(grid);
  return start + halo * row_floats;
}

/* Row 0 of a column of another pair. */
static inline __global float* ring_column(int pair, int column, const Walk* walk, Shape grid) {
  return walk->rings + (size_t)(pair * grid->ring + (column & (grid->ring - 1))) * column_floats(grid) +
         halo * row_floats;
}

/* The tile's own position (part 0) or velocity (part 1) in a pair, of which `pair` is row 0 of the column. */
MSSIM_INLINE Vector load_part(__global const float* pair, int part, Tile tile, Shape grid) {
  return load_vector(pair + tile.first + 3 * part * MSSIM_LANES, MSSIM_LANES);
}
MSSIM_INLINE void store_part(Vector value, __global float* pair, int part, Tile tile, Shape grid) {
  store_vector(value, pair + tile.first + 3 * part * MSSIM_LANES, MSSIM_LANES);
}

/* The nodes of a row. column: begin of its row 0. */
static inline Node load_node(__global const float* column, int row) {
  return load_components(column + row * row_floats, MSSIM_LANES);
}

/* A column being processed. */
typedef struct {
  /* Row 0 in the gathered pair, of this column and of the two to its right. */
  __global const float *here, *next, *next_2;
  /* Forces on the rows of these columns so far, three vectors each. */
  __global float *on_here, *on_next, *on_next_2;
  /* Rows of the cloth that have a spring of each kind in this column. */
  uint down_rows, down_2_rows, right_rows, diagonal_rows, right_2_rows;
} Column;

/* The column that stage number `stage` of the launch is at. here, next, next_2: see Column. */
static inline Column column_at(int column, int stage, __global const float* here, __global const float* next,
                               __global const float* next_2, const Walk* walk, Shape grid) {
  const bool has_next = column + 1 < grid->columns, has_next_2 = column + 2 < grid->columns;
  const uint rows = grid->rows;
  __global float* sums = walk->sums + (size_t)stage * 3 * sums_floats(grid);
  Column at;
  at.here = here;
  at.next = next;
  at.next_2 = next_2;
  at.on_here = sums + column % 3 * sums_floats(grid);
  at.on_next = sums + (column + 1) % 3 * sums_floats(grid);
  at.on_next_2 = sums + (column + 2) % 3 * sums_floats(grid);
  at.down_rows = rows - 1;
  at.down_2_rows = rows > 2 ? rows - 2 : 0;
  at.right_rows = has_next ? rows : 0;
  at.diagonal_rows = has_next ? rows - 1 : 0;
  at.right_2_rows = has_next_2 ? rows : 0;
  return at;
}

/* Clears the sums that the first column of a walk starts from. */
static inline void clear_sums(const Column* at, Shape grid) {
  for (size_t i = 0; i < sums_floats(grid); i += MSSIM_LANES) {
    store_aligned((Real)(0.0f), at->on_here + i);
    store_aligned((Real)(0.0f), at->on_next + i);
  }
}

/* Forces on the rows below: in this column, and in the next one on the rows above and below. */
typedef struct {
  Vector below, below_2, right_above, right_below;
} Carry;

/* Number of each lane's row in the cloth; a halo row above the cloth wraps to a huge number, which exceeds
 * every limit. */
static inline Rows cloth_rows(int row, Shape grid) {
  return MSSIM_PASTE(convert_uint, MSSIM_LANES)(lane_number) * (uint)grid->height + (uint)row;
}

/* Prefetches the row that the walk reaches a fixed number of rows later: columns are contiguous, so every
 * address is valid. Only if the kernel is compiled for the CPU itself: other compilers may lack the built-in
 * function. */
static inline void prefetch_row(__global const float* row) {
#if defined(__x86_64__) || defined(__aarch64__)
  for (int component = 0; component < 6; ++component)
    __builtin_prefetch((const void*)(size_t)(row + 16 * row_floats + component * MSSIM_LANES));
#endif
}

/* Computes the springs that a row owns, and returns the forces on its nodes. `prefetch`: not 0 if the state
 * is gathered; other pairs are in a cache. */
MSSIM_INLINE Vector walk_row(const Column* at, Node node, int row, Carry* carry, int prefetch, Shape grid) {
  const Rows number = cloth_rows(row, grid);
  Vector force = plus(carry->below, load_vector(at->on_here + row * 3 * MSSIM_LANES, MSSIM_LANES));
  Vector on_below = carry->below_2, on_below_2 = no_vector(), on_right_2 = no_vector();
  add_spring(&force, &on_below, node, load_node(at->here, row + 1), number < at->down_rows, structural, grid);
  add_spring(&force, &on_below_2, node, load_node(at->here, row + 2), number < at->down_2_rows, bending,
             grid);
  add_spring(&force, &carry->right_above, node, load_node(at->next, row - 1), number - 1 < at->diagonal_rows,
             shear, grid);
  if (row > 0) store_vector(carry->right_above, at->on_next + (row - 1) * 3 * MSSIM_LANES, MSSIM_LANES);
  Vector on_right = plus(carry->right_below, load_vector(at->on_next + row * 3 * MSSIM_LANES, MSSIM_LANES));
  add_spring(&force, &on_right, node, load_node(at->next, row), number < at->right_rows, structural, grid);
  carry->right_above = on_right;
  carry->right_below = no_vector();
  add_spring(&force, &carry->right_below, node, load_node(at->next, row + 1), number < at->diagonal_rows,
             shear, grid);
  if (prefetch) prefetch_row(at->next_2 + row * row_floats);
  add_spring(&force, &on_right_2, node, load_node(at->next_2, row), number < at->right_2_rows, bending, grid);
  store_vector(on_right_2, at->on_next_2 + row * 3 * MSSIM_LANES, MSSIM_LANES);
  carry->below = on_below;
  carry->below_2 = on_below_2;
  return force;
}

/* Forces of the halo rows above a band on it. */
MSSIM_INLINE Carry begin_column(const Column* at, Shape grid) {
  Carry carry = {no_vector(), no_vector(), no_vector(), no_vector()};
  Vector on_halo = no_vector();
  const Node second = load_node(at->here, -2), first = load_node(at->here, -1), top = load_node(at->here, 0);
  const Rows number = cloth_rows(-1, grid);
  add_spring(&on_halo, &carry.below, second, top, number - 1 < at->down_2_rows, bending, grid);
  add_spring(&on_halo, &carry.below, first, top, number < at->down_rows, structural, grid);
  add_spring(&on_halo, &carry.below_2, first, load_node(at->here, 1), number < at->down_2_rows, bending,
             grid);
  add_spring(&on_halo, &carry.right_below, first, load_node(at->next, 0), number < at->diagonal_rows, shear,
             grid);
  return carry;
}

/* Forces of the halo row below a band on the next column. */
MSSIM_INLINE void end_column(const Column* at, Carry* carry, Shape grid) {
  Vector on_halo = no_vector();
  const int row = grid->height;
  add_spring(&on_halo, &carry->right_above, load_node(at->here, row), load_node(at->next, row - 1),
             cloth_rows(row - 1, grid) < at->diagonal_rows, shear, grid);
  store_vector(carry->right_above, at->on_next + (row - 1) * 3 * MSSIM_LANES, MSSIM_LANES);
}

/* Copies the rows at the ends of the bands of a written column to the halo rows of their neighbours. column:
 * its row 0. */
static inline void fill_halo_rows(__global float* column, Shape grid) {
  const int height = grid->height * row_floats;
  for (int i = 0; i < halo * row_floats; i += MSSIM_LANES) {
    store_aligned(from_lane_before(load_aligned(column + height - halo * row_floats + i)),
                  column - halo * row_floats + i);
    store_aligned(from_lane_after(load_aligned(column + i)), column + height + i);
  }
}

static inline void copy_column(__global const float* from, __global float* to, Shape grid) {
  for (size_t i = 0; i < column_floats(grid); i += MSSIM_LANES) store_aligned(load_aligned(from + i), to + i);
}

/* Copies a column of the state after the launch to the ghosts of the neighbouring partitions. */
static inline void leave_ghosts(int column, const Walk* walk, Shape grid) {
  const Partition* partition = &walk->partition;
  __global const float* start = state_column(column, walk, grid) - halo * row_floats;
  if (column < partition->first + grid->ghosts && partition->number > 0)
    copy_column(
        start,
        ghost(walk->next_ghosts, partition->number - 1, column - partition->first + grid->ghosts, grid),
        grid);
  if (column >= partition->end - grid->ghosts && partition->number + 1 < partition->count)
    copy_column(start,
                ghost(walk->next_ghosts, partition->number + 1, column - partition->end + grid->ghosts, grid),
                grid);
}
