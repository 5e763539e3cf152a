/* The floor under every lane's node. Needs lanes.h, floor_law.h and surroundings.h. */

/* Puts the free nodes that have fallen through the floor back onto it. */
static inline void touch_floor(Vector* x, Vector* v, Mask free,
                               __constant struct Surroundings* surroundings) {
  Mask below = (x->y < surroundings->floor_height) & free;
  if (!any_lane(below)) return;
  Vector after = floor_velocity(*v, (Real)(surroundings->restitution), (Real)(surroundings->friction));
  x->y = select(x->y, (Real)(surroundings->floor_height), below);
  *v = where(below, after, *v);
}
