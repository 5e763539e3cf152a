/* Slices of alike bodies (AlikeSlices in src/backends/layouts): one node of MSSIM_SLICE bodies, x y z u v w
 * of all of them one after the other. Needs lanes.h, and MSSIM_SLICE, a multiple of MSSIM_LANES.
 */
#define slice_floats (6 * MSSIM_SLICE)

static inline Vector load_of_slice(__global const float* from) {
  const Vector value = {load_aligned(from), load_aligned(from + MSSIM_SLICE),
                        load_aligned(from + 2 * MSSIM_SLICE)};
  return value;
}
static inline void store_to_slice(Vector value, __global float* to) {
  store_aligned(value.x, to);
  store_aligned(value.y, to + MSSIM_SLICE);
  store_aligned(value.z, to + 2 * MSSIM_SLICE);
}
/* The nodes of MSSIM_LANES bodies. */
static inline Node load_node_of_slice(__global const float* from) {
  const Node node = {load_of_slice(from), load_of_slice(from + 3 * MSSIM_SLICE)};
  return node;
}
