/* Computes one acceleration per spring of alike bodies, as packed_springs.cl computes one force per spring.
 * This is the device's share of hybrid if a scene has enough alike bodies.
 *
 * The ends of a spring are two slices (lanes.h; AlikeSprings in src/backends/layouts), so no gather is
 * needed.
 */
#define spring_parts (MSSIM_SLICE / MSSIM_LANES)

/* nodes: slices (lanes.h). forces: [springs][x y z][16], accelerations (m/s^2) of the first ends;
 * those of the second ends are the opposite. springs: first slice, second slice, stiffness times rest length
 * / mass (the bits of a float, m/s^2), and an index into shapes: constants divided by a mass. A work-item
 * handles `count` parts of springs, MSSIM_LANES lanes each, up to parts_end. */
__kernel void alike_spring_forces(__global const float* restrict nodes, __global float* restrict forces,
                                  __global const uint4* restrict springs,
                                  __global const struct SpringFloats* restrict shapes, uint parts_end,
                                  uint count) {
  const size_t begin = get_global_id(0) * count;
  const size_t end = min(begin + count, (size_t)parts_end);
  for (size_t part = begin; part < end; ++part) {
    const size_t number = part / spring_parts, lane = part % spring_parts * MSSIM_LANES;
    const uint4 spring = springs[number];
    const struct SpringFloats shape = shapes[spring.w];
    const Node first = load_components(nodes + slice_floats * (size_t)spring.x + lane, MSSIM_SLICE);
    const Node second = load_components(nodes + slice_floats * (size_t)spring.y + lane, MSSIM_SLICE);
    const Vector d = minus(second.x, first.x);
    const Real pull = spring_pull(dot_product(d, d), dot_product(minus(second.v, first.v), d),
                                  spring_in_every_lane(shape, (Real)(as_float(spring.z))));
    store_vector(times(pull, d), forces + number * 3 * MSSIM_SLICE + lane, MSSIM_SLICE);
  }
}
