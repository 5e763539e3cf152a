/* One force per spring, as Hong et al. share the work between GPU and CPU: the device computes the forces of
 * the packed spring units, the host sums them at the nodes and integrates.
 *
 * A unit is what Hong et al., Figure 6, pack for each spring: its two nodes and its rest length (m). Sixteen
 * of them lie side by side (sixteen first nodes, sixteen second nodes, sixteen rest lengths), so that
 * neighbouring work-items, or the lanes of one, read neighbouring memory. They share stiffness and damping.
 */
#define units_side_by_side 16

/* In which order MSSIM_LANES units are taken into the lanes: so that their forces, transposed back, follow
 * each other in memory. */
#define unit_of(lane) ((lane) % 4 * (MSSIM_LANES / 4) + (lane) / 4)
#if MSSIM_LANES == 8
#define in_lane_order(numbers) (numbers).s02461357
#elif MSSIM_LANES == 16
#define in_lane_order(numbers) (numbers).s048c159d26ae37bf
#else
#define in_lane_order(numbers) (numbers)
#endif

/* Force on the first end of MSSIM_LANES units, N, as (x, y, z, 0) each; on the other end it is the opposite.
 * units: the first one's place among the sixteen; material: stiffness (N/m), damping (N s/m). */
static inline void forces_of_units(__global const uint* restrict units, __global const float* restrict nodes,
                                   __global float* restrict forces, float2 material) {
#if MSSIM_LANES == 1
#define first_node(lane) units[0]
#define second_node(lane) units[units_side_by_side]
#else
#define first_node(lane) units[unit_of(lane)]
#define second_node(lane) units[units_side_by_side + unit_of(lane)]
#endif
  const Node first = load_records(nodes, first_node), second = load_records(nodes, second_node);
  const Real rest_length = in_lane_order(load_aligned((__global const float*)units + 2 * units_side_by_side));
  const Vector d = minus(second.x, first.x);
  const Real pull = spring_pull(dot_product(d, d), dot_product(minus(second.v, first.v), d),
                                (Real)(material.x), material.x * rest_length, (Real)(material.y));
  const Vector force = times(pull, d);
#if MSSIM_LANES == 1
  store_quads(force, forces, 4);
#else
  const Quads quads = quads_of(force);
  store_aligned(quads.from_0, forces);
  store_aligned(quads.from_1, forces + MSSIM_LANES);
  store_aligned(quads.from_2, forces + 2 * MSSIM_LANES);
  store_aligned(quads.from_3, forces + 3 * MSSIM_LANES);
#endif
}

/* nodes: records (records.h). kinds: of each sixteen units, an index into `materials`.
 * A work-item takes `count` times MSSIM_LANES units, one lot after the other, up to `units_end`. */
__kernel void packed_spring_forces(__global const uint* restrict units, __global const float* restrict nodes,
                                   __global float* restrict forces, __global const uint* restrict kinds,
                                   __global const float2* restrict materials, uint units_end, uint count) {
  const size_t begin = get_global_id(0) * count * MSSIM_LANES;
  const size_t end = min(begin + count * MSSIM_LANES, (size_t)units_end);
  for (size_t unit = begin; unit < end; unit += MSSIM_LANES) {
    const size_t group = unit / units_side_by_side;
    forces_of_units(units + group * 3 * units_side_by_side + unit % units_side_by_side, nodes,
                    forces + 4 * unit, materials[kinds[group]]);
  }
}
