/* What the stage kernels of a grid have in common. A work-item owns MSSIM_LANES neighbouring nodes of one
 * row: it gathers the forces of their springs and then runs the stage's lines, all in registers. The kernels
 * themselves, and `spring_forces`, are generated from the tables of integrators and of the stencil
 * (src/backends/opencl_program.cpp) and follow this text.
 */

/* Where a work-item's nodes are. */
typedef struct {
  int row;
  Mask column;
  Mask free; /* is a node of the cloth and not pinned */
  int first; /* offset of its first node in a plane */
} Site;

/* pin_rows[row] is the line of `pins` that belongs to the row, or negative where the row has no pinned node.
 * pins[line][column] is -1 for a pinned node, 0 for a free one. */
static inline Site find_site(__constant struct GridParameters* grid, __global const int* restrict pin_rows,
                             __global const int* restrict pins) {
  Site site;
  int column = (int)get_global_id(0) * MSSIM_LANES;
  site.row = (int)get_global_id(1);
  site.column = column + load_lanes(lane_numbers);
  site.first = (site.row + 2) * grid->stride + 16 + column;
  site.free = (site.column < grid->columns) & all_lanes(site.row < grid->rows);
  int line = site.row < grid->rows ? pin_rows[site.row] : -1;
  if (line >= 0) site.free &= load_lanes(pins + line * grid->stride + column) == 0;
  return site;
}

static inline Vector load_vector(__global const float* from, int plane) {
  Vector value = {load_lanes(from), load_lanes(from + plane), load_lanes(from + 2 * plane)};
  return value;
}

static inline void store_vector(Vector value, __global float* to, int plane) {
  store_lanes(value.x, to);
  store_lanes(value.y, to + plane);
  store_lanes(value.z, to + 2 * plane);
}

/* `sum` and the pull of the springs to the nodes that lie `down` rows below and `right` columns to the right.
 * Where the cloth ends, whatever the padding holds is computed with and then left out. */
static inline Vector add_spring(Vector sum, __global const float* restrict pair, Site site, Vector x,
                                Vector v, int down, int right, int kind,
                                __constant struct GridParameters* grid) {
  __global const float* other = pair + site.first + down * grid->stride + right;
  Vector d = minus(load_vector(other, grid->plane), x);
  Vector u = minus(load_vector(other + 3 * grid->plane, grid->plane), v);
  Real pull = spring_pull(dot_product(d, d), dot_product(u, d), (Real)(grid->stiffness[kind]),
                          (Real)(grid->stiffness_rest[kind]), (Real)(grid->damping[kind]));
  Mask there = (site.column + right >= 0) & (site.column + right < grid->columns) &
               all_lanes(site.row + down >= 0 && site.row + down < grid->rows);
  return times_plus(select((Real)(0.0f), pull, there), d, sum);
}

static inline Vector spring_forces(__global const float* restrict pair, Site site, Vector x, Vector v,
                                   __constant struct GridParameters* grid);

/* Acceleration of the site's nodes at the positions x and velocities v that `pair` holds. A pinned node has
 * none: with its speed of zero it then stays where it is under every integrator. */
static inline Vector acceleration(__global const float* restrict pair, Site site, Vector x, Vector v,
                                  __constant struct GridParameters* grid) {
  Vector nothing = {(Real)(0.0f), (Real)(0.0f), (Real)(0.0f)};
  Vector a = times_plus((Real)(-grid->viscous_damping), v, spring_forces(pair, site, x, v, grid));
  a.y -= grid->gravity;
  return where(site.free, a, nothing);
}

/* Puts the free nodes that have fallen through the floor back onto it. */
static inline void touch_floor(Vector* x, Vector* v, Site site, __constant struct GridParameters* grid) {
  Mask below = (x->y < grid->floor_height) & site.free;
  if (!any_lane(below)) return;
  Real rebound = floor_rebound(v->y, (Real)(grid->restitution));
  Real grip = floor_grip(rebound - v->y, mul_add(v->x, v->x, v->z * v->z), (Real)(grid->friction));
  Vector after = {grip * v->x, rebound, grip * v->z};
  x->y = select(x->y, (Real)(grid->floor_height), below);
  *v = where(below, after, *v);
}
