/* The acceleration of a node, written once in the common subset of C++ and OpenCL C:
 *
 *     a = F/m - c v - g,
 *
 * F: the sum of its springs' forces (N), m: its mass (kg), c: viscous damping (1/s), g: gravity, along y.
 *
 * Text for many number types like floor_law.h.
 */

/* pull: F/m (m/s^2); velocity in m/s; damping in 1/s; gravity: in m/s^2, downwards. */
MSSIM_VECTOR_LAW node_acceleration(Vector pull, Vector velocity, Real damping, Real gravity) {
  Vector a = {mul_add(-damping, velocity.x, pull.x), mul_add(-damping, velocity.y, pull.y) - gravity,
              mul_add(-damping, velocity.z, pull.z)};
  return a;
}

/* The same, the product rounded before it is subtracted also where mul_add is one operation: dressings take
 * this one. They decide by thresholds, which the last bit may turn into another run. */
MSSIM_VECTOR_LAW node_acceleration_unfused(Vector pull, Vector velocity, Real damping, Real gravity) {
  Vector drag = {damping * velocity.x, damping * velocity.y, damping * velocity.z};
  Vector a = {pull.x - drag.x, pull.y - drag.y - gravity, pull.z - drag.z};
  return a;
}
