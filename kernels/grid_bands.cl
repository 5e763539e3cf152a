/* What the stage kernels of a grid have in common where a work-item has several lanes: the shape that suits a
 * CPU. The kernels themselves are generated from the table of integrators
 * (src/backends/opencl/grid_program.cpp) and follow this text.
 *
 * The layout is that of BandLayout (src/backends/layouts/band_grid.h): the rows are cut into MSSIM_LANES
 * bands of `height` rows, lane b holds band b, and a pair is
 *
 *     [column][row -2 .. height + 1][x y z u v w][lane],
 *
 * so that every neighbour is an aligned load of the same lane. Two halo rows above and below repeat rows of
 * the neighbouring bands.
 *
 * A work-item walks over its columns from the left, down the rows in each, and computes every spring once, at
 * its left or upper end. What a spring does to the other end waits: in registers for the rows below, in
 * `sums` for the next two columns. The two columns left of its own it walks over too, for what they do to
 * them.
 *
 * No spring points back, so that a stage may write over what it gathers from: half the memory, which decides
 * the speed of a cloth that fills a cache. Columns of another work-item, which may be written already, are
 * gathered from its partition's ghosts, and each pair has ghosts of its own, whatever memory it shares.
 */
#define row_floats (6 * MSSIM_LANES)

typedef MSSIM_PASTE(uint, MSSIM_LANES) Rows;

/* Where MSSIM_LANES nodes are, one in each band. */
typedef struct {
  size_t first; /* offset in a pair */
  Mask free;    /* is a node of the cloth and not pinned */
} Tile;

static inline size_t column_floats(Shape grid) { return (size_t)(grid->height + 4) * row_floats; }
/* Offset of row 0 of a column in a pair. */
static inline size_t column_start(size_t column, Shape grid) {
  return column * column_floats(grid) + 2 * row_floats;
}

/* The columns of a work-item. */
typedef struct {
  int number, count; /* of this partition, and of all */
  int first, end;    /* columns; at least two */
} Partition;
static inline Partition partition_of(int number, int count, Shape grid) {
  Partition partition = {number, count, (int)((long)grid->columns * number / count),
                         (int)((long)grid->columns * (number + 1) / count)};
  return partition;
}

/* The ghosts of a pair: [partition][column first - 2, first - 1, end, end + 1], columns as in a pair. */
static inline __global float* ghosts_of(int pair, __global float* ghosts, const Partition* partition,
                                        Shape grid) {
  return ghosts + (size_t)pair * partition->count * 4 * column_floats(grid);
}
static inline __global float* ghost(__global float* ghosts, int partition, int number, Shape grid) {
  return ghosts + (size_t)(4 * partition + number) * column_floats(grid) + 2 * row_floats;
}

/* Row 0 of a column that the partition gathers. */
static inline __global const float* gathered_column(int column, __global const float* pair,
                                                    __global float* ghosts, const Partition* partition,
                                                    Shape grid) {
  if (column < partition->first) return ghost(ghosts, partition->number, column - partition->first + 2, grid);
  if (column >= partition->end) return ghost(ghosts, partition->number, column - partition->end + 2, grid);
  return pair + column_start(column, grid);
}

static inline Vector load_vector(__global const float* from) {
  Vector value = {load_aligned(from), load_aligned(from + MSSIM_LANES), load_aligned(from + 2 * MSSIM_LANES)};
  return value;
}
static inline void store_vector(Vector value, __global float* to) {
  store_aligned(value.x, to);
  store_aligned(value.y, to + MSSIM_LANES);
  store_aligned(value.z, to + 2 * MSSIM_LANES);
}

/* The tile's own vectors in a pair. */
static inline Vector load_position(__global const float* pair, Tile tile, Shape grid) {
  return load_vector(pair + tile.first);
}
static inline Vector load_velocity(__global const float* pair, Tile tile, Shape grid) {
  return load_vector(pair + tile.first + 3 * MSSIM_LANES);
}
static inline void store_position(Vector value, __global float* pair, Tile tile, Shape grid) {
  store_vector(value, pair + tile.first);
}
static inline void store_velocity(Vector value, __global float* pair, Tile tile, Shape grid) {
  store_vector(value, pair + tile.first + 3 * MSSIM_LANES);
}

/* The nodes of a row. column: where its row 0 begins. */
static inline Node load_node(__global const float* column, int row) {
  __global const float* from = column + row * row_floats;
  Node node = {load_vector(from), load_vector(from + 3 * MSSIM_LANES)};
  return node;
}

/* A column under way. */
typedef struct {
  /* Row 0 in the gathered pair, and of the two columns to the right. */
  __global const float *here, *next, *next_2;
  /* What acts on the rows of these columns so far, three vectors each. */
  __global float *on_here, *on_next, *on_next_2;
  /* Rows of the cloth that have a spring of each kind in this column. */
  uint down_rows, down_2_rows, right_rows, diagonal_rows, right_2_rows;
} Column;

static inline size_t sums_floats(Shape grid) { return (size_t)grid->height * 3 * MSSIM_LANES; }

/* `sums` are three columns, used in turn. */
static inline Column column_at(int column, __global const float* pair, __global float* ghosts,
                               __global float* sums, const Partition* partition, Shape grid) {
  const bool has_next = column + 1 < grid->columns, has_next_2 = column + 2 < grid->columns;
  const uint rows = grid->rows;
  Column at;
  at.here = gathered_column(column, pair, ghosts, partition, grid);
  at.next = gathered_column(column + 1, pair, ghosts, partition, grid);
  at.next_2 = gathered_column(column + 2, pair, ghosts, partition, grid);
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

/* What the first two columns of a walk start from. */
static inline void clear_sums(__global float* sums, int column, Shape grid) {
  for (int right = 0; right < 2; ++right) {
    __global float* begin = sums + (column + right) % 3 * sums_floats(grid);
    for (size_t i = 0; i < sums_floats(grid); i += MSSIM_LANES) store_aligned((Real)(0.0f), begin + i);
  }
}

/* What waits for the rows below: forces on them in this column, and on the rows above and below in the next
 * one. */
typedef struct {
  Vector below, below_2, right_above, right_below;
} Carry;

/* Number of each lane's row in the cloth; a halo row above the cloth wraps to a huge number, which is below
 * no limit. */
static inline Rows cloth_rows(int row, Shape grid) {
  return MSSIM_PASTE(convert_uint, MSSIM_LANES)(lane_number) * (uint)grid->height + (uint)row;
}

/* Asks for the row of a column of states that the walk comes to next but so many: behind a column's end lies
 * the next one, and no address is wrong. Only where the kernel is compiled for the processor itself: other
 * compilers need not have the built-in function. */
static inline void prefetch_row(__global const float* row) {
#if defined(__x86_64__) || defined(__aarch64__)
  for (int component = 0; component < 6; ++component)
    __builtin_prefetch((const void*)(size_t)(row + 16 * row_floats + component * MSSIM_LANES));
#endif
}

/* Computes the springs that a row owns, and returns what acts on its nodes. */
MSSIM_INLINE Vector walk_row(const Column* at, Node node, int row, Carry* carry, Shape grid) {
  const Rows number = cloth_rows(row, grid);
  Vector force = plus(carry->below, load_vector(at->on_here + row * 3 * MSSIM_LANES));
  Vector on_below = carry->below_2, on_below_2 = no_vector(), on_right_2 = no_vector();
  add_spring(&force, &on_below, node, load_node(at->here, row + 1), number < at->down_rows, structural, grid);
  add_spring(&force, &on_below_2, node, load_node(at->here, row + 2), number < at->down_2_rows, bending,
             grid);
  add_spring(&force, &carry->right_above, node, load_node(at->next, row - 1), number - 1 < at->diagonal_rows,
             shear, grid);
  if (row > 0) store_vector(carry->right_above, at->on_next + (row - 1) * 3 * MSSIM_LANES);
  Vector on_right = plus(carry->right_below, load_vector(at->on_next + row * 3 * MSSIM_LANES));
  add_spring(&force, &on_right, node, load_node(at->next, row), number < at->right_rows, structural, grid);
  carry->right_above = on_right;
  carry->right_below = no_vector();
  add_spring(&force, &carry->right_below, node, load_node(at->next, row + 1), number < at->diagonal_rows,
             shear, grid);
  prefetch_row(at->next_2 + row * row_floats);
  add_spring(&force, &on_right_2, node, load_node(at->next_2, row), number < at->right_2_rows, bending, grid);
  store_vector(on_right_2, at->on_next_2 + row * 3 * MSSIM_LANES);
  carry->below = on_below;
  carry->below_2 = on_below_2;
  return force;
}

/* What the halo rows above a band do to it. */
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

/* What the halo row below a band does to the next column. */
MSSIM_INLINE void end_column(const Column* at, Carry* carry, Shape grid) {
  Vector on_halo = no_vector();
  const int row = grid->height;
  add_spring(&on_halo, &carry->right_above, load_node(at->here, row), load_node(at->next, row - 1),
             cloth_rows(row - 1, grid) < at->diagonal_rows, shear, grid);
  store_vector(carry->right_above, at->on_next + (row - 1) * 3 * MSSIM_LANES);
}

static inline void copy_column(__global const float* from, __global float* to, Shape grid) {
  for (int i = -2 * row_floats; i < (grid->height + 2) * row_floats; i += MSSIM_LANES)
    store_aligned(load_aligned(from + i), to + i);
}

/* Makes a column that is written ready to be gathered: repeats the rows at the ends of the bands in the halo
 * rows of their neighbours, and the column in the ghosts of the partitions beside this one. */
static inline void finish_column(int column, __global float* pair, __global float* ghosts,
                                 const Partition* partition, Shape grid) {
  __global float* start = pair + column_start(column, grid);
  const int height = grid->height * row_floats;
  for (int i = 0; i < 2 * row_floats; i += MSSIM_LANES) {
    store_aligned(from_lane_before(load_aligned(start + height - 2 * row_floats + i)),
                  start - 2 * row_floats + i);
    store_aligned(from_lane_after(load_aligned(start + i)), start + height + i);
  }
  if (column < partition->first + 2 && partition->number > 0)
    copy_column(start, ghost(ghosts, partition->number - 1, column - partition->first + 2, grid), grid);
  if (column >= partition->end - 2 && partition->number + 1 < partition->count)
    copy_column(start, ghost(ghosts, partition->number + 1, column - partition->end + 2, grid), grid);
}
