/* Code shared by the stage kernels of alike bodies; it replaces mesh_stage.cl. A work-item takes tiles one
 * after the other. A tile is one node of MSSIM_LANES bodies, and each node gathers the forces of all its
 * springs: whole vectors, because the neighbours of a node are the same in every body.
 *
 * A pair is an array of slices (lanes.h). Constants are per unit of node mass.
 */
typedef struct {
  __global const uint4* slices;  /* begin and end of its springs, its bodies' first slice, 1: pinned */
  __global const uint2* springs; /* the neighbour's slice, relative to the bodies' first; stiffness times rest
                                    length, m/s^2, the bits of a float */
  __global const struct SpringFloats* constants; /* [slices] */
} Mesh;
typedef const Mesh* Shape;

/* Location of the nodes of MSSIM_LANES bodies. */
typedef struct {
  size_t slice, lane;
  Mask free;
} Tile;

static inline Tile tile_at(uint number, const Mesh* mesh) {
  const size_t first = (size_t)number * MSSIM_LANES;
  Tile tile;
  tile.slice = first / MSSIM_SLICE;
  tile.lane = first % MSSIM_SLICE;
  tile.free = all_lanes(mesh->slices[tile.slice].w == 0);
  return tile;
}
#define own_floats(pair, tile) ((pair) + slice_floats * (tile).slice + (tile).lane)

static inline Node load_node(__global const float* restrict pair, Tile tile) {
  return load_components(own_floats(pair, tile), MSSIM_SLICE);
}

/* The tile's own position (part 0) or velocity (part 1) in a pair. */
MSSIM_INLINE Vector load_part(__global const float* pair, int part, Tile tile, Shape mesh) {
  return load_vector(own_floats(pair, tile) + 3 * part * MSSIM_SLICE, MSSIM_SLICE);
}
MSSIM_INLINE void store_part(Vector value, __global float* pair, int part, Tile tile, Shape mesh) {
  store_vector(value, own_floats(pair, tile) + 3 * part * MSSIM_SLICE, MSSIM_SLICE);
}

/* Sum of the forces of all springs on the tile's nodes, m/s^2. */
static inline Vector gather_springs(__global const float* restrict pair, Tile tile, Node node,
                                    const Mesh* mesh) {
  const uint4 own = mesh->slices[tile.slice];
  const struct SpringFloats constants = mesh->constants[tile.slice];
  __global const float* bodies = pair + slice_floats * (size_t)own.z + tile.lane;
  Vector sum = no_vector();
  for (uint number = own.x; number < own.y; ++number) {
    const uint2 spring = mesh->springs[number];
    const Node other = load_components(bodies + slice_floats * (size_t)spring.x, MSSIM_SLICE);
    const Vector d = minus(other.x, node.x);
    const Real pull = spring_pull(dot_product(d, d), dot_product(minus(other.v, node.v), d),
                                  spring_in_every_lane(constants, (Real)(as_float(spring.y))));
    sum = times_plus(pull, d, sum);
  }
  return sum;
}
