/* What the stage kernels of a grid have in common. The kernels themselves are generated from the tables of
 * integrators and of the stencil (src/backends/opencl/grid_program.cpp) and follow this text. They come in
 * two shapes:
 * - one lane: a work-item owns one node, gathers the forces of all its springs and runs the stage's lines on
 * it;
 * - several lanes: a work-item walks row by row, in each row to the right, over a block of rows, so that it
 *   computes every spring once. What a spring does to nodes that come later waits in registers within a row,
 * and in `sums` from row to row. The two rows above a block are walked over too, for what they do to it.
 */

/* Where MSSIM_LANES neighbouring nodes are. */
typedef struct {
  int row;
  int first_column;
  int first; /* offset of the first node in a plane */
  Mask column;
  Mask free; /* is a node of the cloth and not pinned */
} Site;

typedef __constant struct GridParameters* Shape;

/* pin_rows[row] is the line of `pins` that belongs to the row, or negative where the row has no pinned node.
 * pins[line][column] is -1 for a pinned node, 0 for a free one. */
static inline Site site_at(int row, int column, __constant struct GridParameters* grid,
                           __global const int* restrict pin_rows, __global const int* restrict pins) {
  Site site;
  site.row = row;
  site.first_column = column;
  site.first = (row + 2) * grid->stride + 16 + column;
  site.column = column + lane_number;
  site.free = (site.column < grid->columns) & all_lanes(row < grid->rows);
  int line = row < grid->rows ? pin_rows[row] : -1;
  if (line >= 0) site.free &= load_lanes(pins + line * grid->stride + column) == 0;
  return site;
}

/* Three planes that lie `plane` floats apart, at any address or at one that is a multiple of a Real's size.
 */
static inline Vector load_vector(__global const float* from, int plane) {
  Vector value = {load_lanes(from), load_lanes(from + plane), load_lanes(from + 2 * plane)};
  return value;
}
static inline Vector load_vector_aligned(__global const float* from, int plane) {
  Vector value = {load_aligned(from), load_aligned(from + plane), load_aligned(from + 2 * plane)};
  return value;
}
static inline void store_vector_aligned(Vector value, __global float* to, int plane) {
  store_aligned(value.x, to);
  store_aligned(value.y, to + plane);
  store_aligned(value.z, to + 2 * plane);
}

/* The site's own vectors in a pair. */
static inline Vector load_position(__global const float* pair, Site site, Shape grid) {
  return load_vector_aligned(pair + site.first, grid->plane);
}
static inline Vector load_velocity(__global const float* pair, Site site, Shape grid) {
  return load_vector_aligned(pair + site.first + 3 * grid->plane, grid->plane);
}
static inline void store_position(Vector value, __global float* pair, Site site, Shape grid) {
  store_vector_aligned(value, pair + site.first, grid->plane);
}
static inline void store_velocity(Vector value, __global float* pair, Site site, Shape grid) {
  store_vector_aligned(value, pair + site.first + 3 * grid->plane, grid->plane);
}

/* The nodes `down` rows below the site and `right` columns to its right. */
static inline Node load_node(__global const float* restrict pair, Site site, int down, int right,
                             __constant struct GridParameters* grid) {
  __global const float* from = pair + site.first + down * grid->stride + right;
  Node node = {load_vector(from, grid->plane), load_vector(from + 3 * grid->plane, grid->plane)};
  return node;
}

static inline Mask is_on_cloth(Site site, int down, int right, __constant struct GridParameters* grid) {
  return (site.column + right >= 0) & (site.column + right < grid->columns) &
         all_lanes(site.row + down >= 0 && site.row + down < grid->rows);
}

/* Adds the force of one spring in every lane to what acts on its ends, m/s^2. Where there is no spring,
 * because the cloth ends, whatever the padding holds is computed with and then left out. */
static inline void add_spring(Vector* on_first, Vector* on_second, Node first, Node second, Mask there,
                              int kind, __constant struct GridParameters* grid) {
  Vector d = minus(second.x, first.x);
  Real pull =
      spring_pull(dot_product(d, d), dot_product(minus(second.v, first.v), d), (Real)(grid->stiffness[kind]),
                  (Real)(grid->stiffness_rest[kind]), (Real)(grid->damping[kind]));
  pull = select((Real)(0.0f), pull, there);
  *on_first = times_plus(pull, d, *on_first);
  *on_second = times_plus(-pull, d, *on_second);
}

#if MSSIM_LANES > 1
/* A work-item's `sums` are three rows, used in turn, of what acts on the nodes of the row that it walks over
 * and of the two rows below: three planes (x, y, z) of `stride` floats each. */
static inline __global float* sums_of(__global float* sums, int row, __constant struct GridParameters* grid) {
  return sums + (row % 3) * 3 * grid->stride;
}

/* What the first two rows of a walk start from. */
static inline void clear_sums(__global float* sums, int row, __constant struct GridParameters* grid) {
  for (int down = 0; down < 2; ++down)
    for (int i = 0; i < 3 * grid->stride; ++i) sums_of(sums, row + down, grid)[i] = 0.0f;
}
#endif
