/* Code shared by the stage kernels of a grid if a work-item owns one node, gathers the forces of all its
 * springs and runs the stage's assignments on it, which suits a GPU. The kernels themselves are generated
 * from the tables of integrators and of the stencil (src/backends/opencl/programs.cpp) and follow this text.
 *
 * Memory of a pair: six planes (x, y, z, u, v, w) of `plane` floats. Node (row, column) is at
 *     (row + 2) * stride + 16 + column
 * of its plane, so two rows above and below, and sixteen floats left of every row (which are also those right
 * of the row before), can be read without a test whether there is a node.
 */
typedef struct {
  int row, column;
  int first; /* offset of the node in a plane */
  Mask free; /* nodes of the cloth that are not pinned */
} Tile;

/* pin_masks[row] is the mask of `pins` that belongs to the row, or negative if the row has no pinned node.
 * pins[mask][column] is -1 for a pinned node, 0 for a free one. */
static inline Tile tile_at(int row, int column, Shape grid, __global const int* restrict pin_masks,
                           __global const int* restrict pins) {
  Tile tile = {row, column, (row + 2) * grid->stride + 16 + column,
               row < grid->rows && column < grid->columns};
  int mask = row < grid->rows ? pin_masks[row] : -1;
  if (mask >= 0) tile.free &= pins[mask * grid->stride + column] == 0;
  return tile;
}

/* The tile's own position (part 0) or velocity (part 1) in a pair. */
MSSIM_INLINE Vector load_part(__global const float* pair, int part, Tile tile, Shape grid) {
  return load_vector(pair + tile.first + 3 * part * grid->plane, grid->plane);
}
MSSIM_INLINE void store_part(Vector value, __global float* pair, int part, Tile tile, Shape grid) {
  store_vector(value, pair + tile.first + 3 * part * grid->plane, grid->plane);
}

/* The node `down` rows below the tile and `right` columns to its right. */
static inline Node load_node(__global const float* restrict pair, Tile tile, int down, int right,
                             Shape grid) {
  return load_components(pair + tile.first + down * grid->stride + right, grid->plane);
}

static inline Mask is_on_cloth(Tile tile, int down, int right, Shape grid) {
  return (tile.column + right >= 0) & (tile.column + right < grid->columns) & (tile.row + down >= 0) &
         (tile.row + down < grid->rows);
}
