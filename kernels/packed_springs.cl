/* Computes one force per spring, as Hong et al. share the work between GPU and CPU: the device computes the
 * forces of the packed spring units, the host sums them at the nodes and integrates.
 *
 * A unit is what Hong et al., Figure 6, pack for each spring: its two nodes and its rest length (m). Sixteen
 * units of one kind are an entry; their first nodes are consecutive and form a slice, so the number of the
 * slice is enough (PackedSprings in src/backends/layouts/packed_springs.h).
 */
#define slice_nodes 16

/* If there are several lanes, a work-item takes whole entries, else one unit at a time. */
#if MSSIM_LANES == 1
#define parts_at_a_time 1
#else
#define parts_at_a_time (slice_nodes / MSSIM_LANES)
#endif
#define units_at_a_time (parts_at_a_time * MSSIM_LANES)

/* Forces on the first nodes of MSSIM_LANES units, N, as (x, y, z, 0) each; those on the second nodes are the
 * opposite. second, rest_length: those of the first unit; material: the units' constants; forces: begin of
 * the entry's forces; lane: the first unit's number in the entry. */
#define second_node(lane) second[lane]
static inline void forces_of_units(Node first, __global const uint* restrict second,
                                   __global const float* restrict rest_lengths,
                                   __global const float* restrict nodes, __global float* restrict forces,
                                   size_t lane, struct SpringFloats material) {
  const Node other = load_records(nodes, second_node);
  const Real rest_length = load_aligned(rest_lengths);
  const Vector d = minus(other.x, first.x);
  Real pull = spring_pull(dot_product(d, d), dot_product(minus(other.v, first.v), d),
                          spring_in_every_lane(material, material.stiffness * rest_length));
  pull = select(pull, (Real)(0.0f), rest_length < 0.0f); /* padding, at distance 0 */
  const Vector force = times(pull, d);
#if MSSIM_LANES == 1
  store_quads(force, forces + 4 * (lane % 4 * 4 + lane / 4), 4);
#else
  const Quads quads = quads_of(force);
  store_aligned(quads.from_0, forces + lane);
  store_aligned(quads.from_1, forces + 16 + lane);
  store_aligned(quads.from_2, forces + 32 + lane);
  store_aligned(quads.from_3, forces + 48 + lane);
#endif
}

/* nodes: records (records.h). entries: the slice of each entry, and an index into `materials`. units:
 * [entries][second node, rest length][16]. forces: [entries][16] of four floats, those of nodes 0, 4, 8 and
 * 12 first, then of 1, 5 and so on. A work-item handles `count` parts of units_at_a_time units, up to
 * parts_end. */
#define first_node(lane) first_number + (lane)
__kernel void packed_spring_forces(__global const float* restrict nodes, __global float* restrict forces,
                                   __global const uint* restrict units,
                                   __global const uint2* restrict entries,
                                   __global const struct SpringFloats* restrict materials, uint parts_end,
                                   uint count) {
  const size_t begin = get_global_id(0) * count * units_at_a_time;
  const size_t end = min(begin + count * units_at_a_time, (size_t)parts_end * units_at_a_time);
  uint slice = 0xffffffffu;
  Node first[parts_at_a_time];
  for (size_t unit = begin; unit < end; unit += units_at_a_time) {
    const size_t entry = unit / slice_nodes, lane = unit % slice_nodes;
    if (entries[entry].x != slice) {
      slice = entries[entry].x;
      for (int part = 0; part < parts_at_a_time; ++part) {
        const size_t first_number = (size_t)slice * slice_nodes + lane + part * MSSIM_LANES;
        first[part] = load_records(nodes, first_node);
      }
    }
    __global const uint* second = units + entry * 2 * slice_nodes + lane;
    for (int part = 0; part < parts_at_a_time; ++part)
      forces_of_units(first[part], second + part * MSSIM_LANES,
                      (__global const float*)second + slice_nodes + part * MSSIM_LANES, nodes,
                      forces + entry * 4 * slice_nodes, lane + part * MSSIM_LANES,
                      materials[entries[entry].y]);
  }
}
