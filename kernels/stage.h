/* What the stage kernels of all topologies have in common. Needs lanes.h, floor_law.h and step_parameters.h.
 */

/* Acceleration of the nodes at the velocities v. A node that is not free has none: with its speed of zero it
 * then stays where it is under every integrator. */
static inline Vector acceleration(Vector spring_forces, Vector v, Mask free,
                                  __constant struct StepParameters* step) {
  Vector a = times_plus((Real)(-step->surroundings.viscous_damping), v, spring_forces);
  a.y -= step->surroundings.gravity;
  return where(free, a, no_vector());
}

/* Puts the free nodes that have fallen through the floor back onto it. */
static inline void touch_floor(Vector* x, Vector* v, Mask free, __constant struct StepParameters* step) {
  Mask below = (x->y < step->surroundings.floor_height) & free;
  if (!any_lane(below)) return;
  Real rebound = floor_rebound(v->y, (Real)(step->surroundings.restitution));
  Real grip =
      floor_grip(rebound - v->y, mul_add(v->x, v->x, v->z * v->z), (Real)(step->surroundings.friction));
  Vector after = {grip * v->x, rebound, grip * v->z};
  x->y = select(x->y, (Real)(step->surroundings.floor_height), below);
  *v = where(below, after, *v);
}
