/* The joints of a garment (garment_laws.h). One work-group handles them level by level, one joint per
 * work-item: joints of a level have no node in common, and joints that share a node are in levels in the
 * garment's order. Needs dressing.cl with one lane.
 */
typedef __global const struct DressingJoint* Joint;

typedef struct {
  Joint all;
  __global const int* level_ends; /* [level] the number of the joint after its last one */
  __global const int* nodes;      /* the held ones, then the others of joints, as offsets in floats */
  __global int* sewn;             /* [joint] */
} Joints;

/* Values of an array at the three nodes of a joint. */
typedef struct {
  Vector node, first, second;
} AtJoint;
MSSIM_INLINE AtJoint load_at_joint(__global const float* array, Joint joint, int plane) {
  AtJoint at = {load_one(array + joint->node, plane), load_one(array + joint->first, plane),
                load_one(array + joint->second, plane)};
  return at;
}

/* Vector from the joint's node to the point that it is sewn to. */
MSSIM_INLINE Vector gap_of(AtJoint at, Joint joint) {
  const Real fraction = (joint->fraction);
  const Vector gap = {joint_gap(at.node.x, at.first.x, at.second.x, fraction),
                      joint_gap(at.node.y, at.first.y, at.second.y, fraction),
                      joint_gap(at.node.z, at.first.z, at.second.z, fraction)};
  return gap;
}
MSSIM_INLINE struct JointEnds ends_of(Joint joint, const GarmentGrid* grid) {
  return joint_ends((joint->fraction), (grid->inverse_mass[joint->node]), (grid->inverse_mass[joint->first]),
                    (grid->inverse_mass[joint->second]));
}

/* Adds to an array what an impulse gives the nodes of a joint, one node after the other, because both ends of
 * an edge may be the same node. */
MSSIM_INLINE void add_one(Real s, Vector a, __global float* to, int plane) {
  store_one(plus(load_one(to, plane), times(s, a)), to, plane);
}
MSSIM_INLINE void add_at_joint(struct JointEnds ends, Vector impulse, __global float* array, Joint joint,
                               int plane) {
  add_one(ends.node, impulse, array + joint->node, plane);
  add_one(ends.first, impulse, array + joint->first, plane);
  add_one(ends.second, impulse, array + joint->second, plane);
}

/* After loop 5, which would open it again: moves the ends of a sewn joint as one, but closes its gap. */
MSSIM_INLINE void close_joint(Joint joint, const GarmentGrid* grid) {
  const struct JointEnds ends = ends_of(joint, grid);
  const Real mobility = joint_mobility(ends, (joint->fraction));
  if (mobility == 0.0f) return;
  const Vector gap = gap_of(load_at_joint(grid->moved, joint, grid->plane), joint);
  const Vector gap_rate = gap_of(load_at_joint(grid->velocity, joint, grid->plane), joint);
  const Real rate =
      closing_rate(sqrt(dot_product(gap, gap)), (grid->rules->closing_most), (grid->rules->closing_speed));
  const Vector impulse = {closing_impulse(gap.x, gap_rate.x, rate, mobility),
                          closing_impulse(gap.y, gap_rate.y, rate, mobility),
                          closing_impulse(gap.z, gap_rate.z, rate, mobility)};
  add_at_joint(ends, impulse, grid->velocity, joint, grid->plane);
}

/* Loop 3 for an open joint: pulls it together, or sews it if its gap is small; returns whether it sewed. */
MSSIM_INLINE int pull_joint(Joint joint, int steps, const GarmentGrid* grid) {
  Rules rules = grid->rules;
  const Vector gap = gap_of(load_at_joint(grid->position, joint, grid->plane), joint);
  const Real distance = sqrt(dot_product(gap, gap));
  if (distance < rules->sewn_gap) return 1;
  const Real force =
      seam_force(rules->seam_force, steps * rules->doublings_per_step, joint->length, joint->strength);
  add_at_joint(ends_of(joint, grid), times(force / distance, gap), grid->pull, joint, grid->plane);
  return 0;
}

/* Loop 3 of the next step: sews the joints whose gap is small enough, and sets the pull of the others. */
MSSIM_INLINE void pull_joints(const Joints* joints, int steps, __global struct DressingState* state,
                              const GarmentGrid* grid) {
  Rules rules = grid->rules;
  for (int i = item; i < rules->joint_nodes; i += items)
    store_one(no_vector(), grid->pull + joints->nodes[i], grid->plane);
  block_barrier();
  for (int level = 0; level < rules->joint_levels; ++level) {
    for (int j = (level > 0 ? joints->level_ends[level - 1] : 0) + item; j < joints->level_ends[level];
         j += items)
      if (!joints->sewn[j] && pull_joint(joints->all + j, steps, grid)) {
        joints->sewn[j] = 1;
        atomic_dec(&state->still_open);
      }
    block_barrier();
  }
}

MSSIM_INLINE void close_sewn_joints(const Joints* joints, const GarmentGrid* grid) {
  for (int level = 0; level < grid->rules->joint_levels; ++level) {
    for (int j = (level > 0 ? joints->level_ends[level - 1] : 0) + item; j < joints->level_ends[level];
         j += items)
      if (joints->sewn[j]) close_joint(joints->all + j, grid);
    block_barrier();
  }
}

#define JOINTS                                                                                         \
  __global const struct DressingJoint *all, __global const int *level_ends, __global const int *nodes, \
      __global int *sewn
#define joints_of_arguments \
  { all, level_ends, nodes, sewn }

/* Before the first step. */
__kernel void begin_joints(GARMENT_GRID, JOINTS) {
  const GarmentGrid grid = grid_of_arguments;
  const Joints joints = joints_of_arguments;
  pull_joints(&joints, 0, state, &grid);
}

/* The end of a step. */
__kernel void step_joints(GARMENT_GRID, JOINTS) {
  const GarmentGrid grid = grid_of_arguments;
  const Joints joints = joints_of_arguments;
  const int was_draping = state->draping, steps = state->steps + 1, open_joints = state->still_open;
  close_sewn_joints(&joints, &grid);
  for (int i = item; i < rules->joint_nodes; i += items) {
    const int at = nodes[i];
    Vector v = load_one(velocity + at, rules->plane);
    if (i < rules->held_nodes && !was_draping) v.y = 0.0f;
    const Vector x = moved_on(load_one(moved + at, rules->plane), &v, inverse_mass[at] > 0.0f, rules);
    store_one(x, position + at, rules->plane);
    store_one(v, velocity + at, rules->plane);
  }
  const int closed = open_joints == 0 || steps >= rules->longest_seaming;
  block_barrier();
  if (item == 0) {
    state->steps = steps;
    state->open_joints = closed ? 0 : open_joints;
    if (closed && !was_draping) {
      state->draping = 1;
      state->seamed_at = steps;
    }
  }
  if (was_draping) return;
  if (closed)
    for (int j = item; j < rules->joints; j += items) sewn[j] = 1;
  else
    pull_joints(&joints, steps, state, &grid);
}
