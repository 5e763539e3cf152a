/* Gravity, damping and the floor for the nodes of every lane. Needs lanes.h, node_laws.h and parameters.h. */

/* Acceleration of the nodes at the velocities v. A node that is not free has none: with its speed of zero it
 * then stays where it is under every integrator. */
static inline Vector acceleration(Vector spring_forces, Vector v, Mask free,
                                  __constant struct StepParameters* step) {
  Vector a = node_acceleration(spring_forces, v, (Real)(step->surroundings.viscous_damping),
                               (Real)(step->surroundings.gravity));
  return where(free, a, no_vector());
}

/* Puts the free nodes that have fallen through the floor back onto it. */
static inline void touch_floor(Vector* x, Vector* v, Mask free,
                               __constant struct Surroundings* surroundings) {
  Mask below = (x->y < surroundings->floor_height) & free;
  if (!any_lane(below)) return;
  Vector after = floor_velocity(*v, (Real)(surroundings->restitution), (Real)(surroundings->friction));
  x->y = select(x->y, (Real)(surroundings->floor_height), below);
  *v = where(below, after, *v);
}
