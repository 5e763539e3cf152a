/* The floor under every lane's node. Needs lanes.h, floor_law.h and surroundings.h. */

/* Puts the free nodes that have fallen through the floor back onto it. */
static inline void touch_floor(Vector* x, Vector* v, Mask free,
                               __constant struct Surroundings* surroundings) {
  Mask below = (x->y < surroundings->floor_height) & free;
  if (!any_lane(below)) return;
  Real rebound = floor_rebound(v->y, (Real)(surroundings->restitution));
  Real grip = floor_grip(rebound - v->y, mul_add(v->x, v->x, v->z * v->z), (Real)(surroundings->friction));
  Vector after = {grip * v->x, rebound, grip * v->z};
  x->y = select(x->y, (Real)(surroundings->floor_height), below);
  *v = where(below, after, *v);
}
