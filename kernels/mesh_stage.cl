/* Code shared by the stage kernels of a tetrahedral body. The kernels themselves are generated from the table
 * of integrators (src/backends/opencl/programs.cpp) and follow this text: a work-item takes tiles of
 * MSSIM_LANES nodes, one after the other, and every node gathers the forces of all its springs.
 *
 * A pair is an array of records (records.h). The springs are those of a sliced graph (SlicedGraph in
 * src/backends/layouts/sliced_graph.h), in slices of MSSIM_SLICE nodes: MSSIM_LANES of them if a tile has
 * several nodes, a multiple if it has one. Their constants are per unit of node mass.
 */
typedef struct {
  __global const uint* first_entry;     /* [slices + 1] */
  __global const uint* neighbour;       /* [entries][MSSIM_SLICE] */
  __global const float* stiffness_rest; /* [entries][MSSIM_SLICE] m/s^2, negative: no spring */
  __global const float* constants; /* [slices][spring_constant_count][MSSIM_SLICE] of the node's springs */
  __global const int* held;        /* 1: pinned, or padding */
} Mesh;
typedef const Mesh* Shape;

/* Location of MSSIM_LANES nodes. */
typedef struct {
  size_t first; /* number of the first node */
  Mask free;
} Tile;

static inline Tile tile_at(uint number, const Mesh* mesh) {
  Tile tile;
  tile.first = (size_t)number * MSSIM_LANES;
  tile.free = load_aligned_mask(mesh->held + tile.first) == 0;
  return tile;
}

#define own_record(lane) tile.first + (lane)
static inline Node load_node(__global const float* restrict pair, Tile tile) {
  return load_records(pair, own_record);
}

/* The tile's own position (part 0) or velocity (part 1) in a pair. */
MSSIM_INLINE Vector load_part(__global const float* pair, int part, Tile tile, Shape mesh) {
  const Node node = load_node(pair, tile);
  return part ? node.v : node.x;
}
MSSIM_INLINE void store_part(Vector value, __global float* pair, int part, Tile tile, Shape mesh) {
  store_quads(value, pair + record_floats * tile.first + 4 * part, record_floats);
}

/* Sum of the forces of all springs on the tile's nodes, m/s^2. If a lane has fewer springs than its slice has
 * entries, the node is its own neighbour, at distance 0, and the result is masked out. */
#define neighbour_record(lane) neighbour[lane]
static inline Vector gather_springs(__global const float* restrict pair, Tile tile, Node node,
                                    const Mesh* mesh) {
  const size_t slice = tile.first / MSSIM_SLICE, lane = tile.first % MSSIM_SLICE;
  const struct SpringConstants constants =
      load_constants(mesh->constants + slice * spring_constant_count * MSSIM_SLICE + lane, MSSIM_SLICE);
  const uint end = mesh->first_entry[slice + 1];
  Vector sum = no_vector();
  for (uint entry = mesh->first_entry[slice]; entry < end; ++entry) {
    const size_t element = (size_t)entry * MSSIM_SLICE + lane;
    __global const uint* neighbour = mesh->neighbour + element;
    const Real stiffness_rest = load_aligned(mesh->stiffness_rest + element);
    const Node other = load_records(pair, neighbour_record);
    const Vector d = minus(other.x, node.x);
    const struct LinearSpring spring = {constants, stiffness_rest};
    Real pull = spring_pull(dot_product(d, d), dot_product(minus(other.v, node.v), d), spring);
    pull = select(pull, (Real)(0.0f), stiffness_rest < 0.0f);
    sum = times_plus(pull, d, sum);
  }
  return sum;
}
