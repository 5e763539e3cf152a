/* The motion of a node apart from its springs, written once in the common subset of C++ and OpenCL C: its
 * acceleration, and the floor.
 *
 * Text for many number types like spring_law.h; besides that file's names it needs
 *   MSSIM_VECTOR_LAW            prefix of a function that returns a Vector, three Reals x, y and z,
 *   dot_product(a, b)           of two Vectors.
 */

/* The acceleration of a node,
 *
 *     a = F/m - c v - g,
 *
 * F: the sum of its springs' forces (N), m: its mass (kg), c: viscous damping (1/s), g: gravity, along y.
 * pull: F/m (m/s^2); velocity in m/s; damping in 1/s; gravity: in m/s^2, downwards. */
MSSIM_VECTOR_LAW node_acceleration(Vector pull, Vector velocity, Real damping, Real gravity) {
  Vector a = {mul_add(-damping, velocity.x, pull.x), mul_add(-damping, velocity.y, pull.y) - gravity,
              mul_add(-damping, velocity.z, pull.z)};
  return a;
}

/* The acceleration with the product rounded before it is subtracted, even if mul_add is one operation.
 * Dressings use this one: they decide by thresholds, where the last bit can change the whole run. */
MSSIM_VECTOR_LAW node_acceleration_unfused(Vector pull, Vector velocity, Real damping, Real gravity) {
  Vector drag = {damping * velocity.x, damping * velocity.y, damping * velocity.z};
  Vector a = {pull.x - drag.x, pull.y - drag.y - gravity, pull.z - drag.z};
  return a;
}

/* The floor puts a node that a step has moved below it back on its surface. The falling speed is multiplied
 * by the restitution and reversed; the sliding speed loses at most friction times the change of the normal
 * speed (Coulomb's law for an impulse).
 */

/* Vertical speed after the contact (m/s). */
MSSIM_LAW floor_rebound(Real vertical, Real restitution) {
  Real none = vertical - vertical;
  return where_less(vertical, none, -(restitution * vertical), vertical);
}

/* Factor on both horizontal speeds after the contact, in [0, 1].
 * normal_change: the vertical speed's change (m/s, not negative); slide_squared: the square of the sliding
 * speed. */
MSSIM_LAW floor_grip(Real normal_change, Real slide_squared, Real friction) {
  Real none = normal_change - normal_change;
  Real one = none + 1.0f;
  /* The smallest normal number keeps the reciprocal finite for a node that does not slide. A larger one would
   * be a speed below which friction is wrong: openmp's unit of time is the step, so its speeds are small. */
  Real least = none + 1.17549435e-38f;
  Real slide = where_less(least, slide_squared, slide_squared, least);
  Real kept = one - friction * normal_change * inverse_sqrt(slide);
  return where_less(kept, none, none, kept);
}

/* Velocity after the contact (m/s). */
MSSIM_VECTOR_LAW floor_velocity(Vector v, Real restitution, Real friction) {
  Real rebound = floor_rebound(v.y, restitution);
  Vector slide = v;
  slide.y = restitution - restitution;
  Real grip = floor_grip(rebound - v.y, dot_product(slide, slide), friction);
  Vector after = {grip * v.x, rebound, grip * v.z};
  return after;
}
