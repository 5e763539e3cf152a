/* One force per spring, as Hong et al. share the work between GPU and CPU: the device computes the forces of
 * the packed spring units, the host sums them at the nodes and integrates.
 */

/* The packed unit of Hong et al., Figure 6. */
typedef struct {
  uint first, second; /* nodes */
  float rest_length;  /* m */
} PackedSpring;

/* Force on the first end of one spring per work-item, N, as (x, y, z, 0); on the other end it is the
 * opposite. The springs of a launch share stiffness (N/m) and damping (N s/m); the launch's offset says where
 * they begin. nodes: [nodes][2], position (m) and velocity (m/s). */
__kernel void packed_spring_forces(__global const PackedSpring* restrict springs,
                                   __global const float4* restrict nodes, __global float4* restrict forces,
                                   float stiffness, float damping) {
  size_t i = get_global_id(0);
  PackedSpring spring = springs[i];
  float4 d = nodes[2 * spring.second] - nodes[2 * spring.first];
  float4 u = nodes[2 * spring.second + 1] - nodes[2 * spring.first + 1];
  float pull =
      spring_pull(dot(d.xyz, d.xyz), dot(u.xyz, d.xyz), stiffness, stiffness * spring.rest_length, damping);
  forces[i] = pull * d;
}
