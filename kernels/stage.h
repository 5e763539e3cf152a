/* What the stage kernels of all topologies have in common. Needs lanes.h, acceleration_law.h and
 * step_parameters.h.
 */

/* Acceleration of the nodes at the velocities v. A node that is not free has none: with its speed of zero it
 * then stays where it is under every integrator. */
static inline Vector acceleration(Vector spring_forces, Vector v, Mask free,
                                  __constant struct StepParameters* step) {
  Vector a = node_acceleration(spring_forces, v, (Real)(step->surroundings.viscous_damping),
                               (Real)(step->surroundings.gravity));
  return where(free, a, no_vector());
}
