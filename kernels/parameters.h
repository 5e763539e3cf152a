/* Parameters of the kernels, in the common subset of C++ and OpenCL C: the host fills these structs and the
 * device reads them. Needs spring_constants.h.
 */
#ifndef MSSIM_PARAMETERS
#define MSSIM_PARAMETERS
#ifndef __OPENCL_VERSION__
#include "kernels/spring_constants.h"
#endif

/* Forces on every node besides springs. */
struct Surroundings {
  float viscous_damping; /* 1/s */
  float gravity;         /* m/s^2, downwards */
  float floor_height;    /* m */
  float restitution;
  float friction;
};

/* Parameters of every stage kernel: the system and the integrator, whatever the topology. */
struct StepParameters {
  struct Surroundings surroundings;
  float coefficients[4][4][5]; /* [stage][assignment][term], dt included */
};

/* Parameters of a grid's stage kernels. All forces are per unit of node mass. */
struct GridParameters {
  int rows;
  int columns;
  struct SpringFloats constants[3]; /* [kinds of springs] */
  float stiffness_rest[3];          /* [kinds] stiffness * rest length, m/s^2 */
  /* For grid_nodes.cl, whose work-items own one node each. */
  int stride; /* floats from one row to the next */
  int plane;  /* floats from one plane to the next */
  /* For grid_bands.cl, whose work-items own columns of several bands. */
  int height; /* rows of a band, at least 2 */
  int ghosts; /* columns on each side of a partition: two for each stage of a launch */
  int ring;   /* columns that a partition keeps of a pair other than the state, a power of two */
};

/* How the work-items of a mesh's stage kernels share its nodes. */
struct MeshParameters {
  unsigned tiles; /* MSSIM_LANES nodes each */
  unsigned tiles_per_item;
};

/* Geometry and layout of a body's maps (src/garment/contact/body_maps.h).
 *
 * Pixel (column, row) covers x from left + column / pixels_per_metre on and y from bottom + row /
 * pixels_per_metre on; row 0 is the lowest. Its record of BODY_FLOATS floats begins at BODY_FLOATS * (row *
 * columns + column): unit normal x y z and n . P of the front plane, then the same of the back plane. Without
 * a body both are 0 0 0 and -1e30, which no point is behind. The pixels along the border are empty, so points
 * outside the maps, which read those, meet no body.
 */
struct BodyFrame {
  float left;   /* m, x of the left edge of column 0 */
  float bottom; /* m, y of the lower edge of row 0 */
  float pixels_per_metre;
  int columns;
  int rows;
};
#define BODY_FLOATS 8

/* Parameters of a dressing. Offsets and distances are in floats. */

/* Forces on the nodes besides springs, joints and the body, in one phase. */
struct DressingPhase {
  float damping; /* 1/s, per unit of mass */
  float gravity; /* m/s^2, downwards */
  float friction;
};

/* Constants of a dressing and of its layout, for all its kernels. */
struct DressingParameters {
  struct Surroundings surroundings; /* its floor */
  struct DressingPhase seaming;     /* before the seams are closed */
  struct DressingPhase draping;     /* from then on */
  float dt;                         /* s */
  float push_speed;                 /* m/s, see body_response */
  float correction_limit;           /* length over rest length, see elongation_excess */
  float correction_rate;            /* 1/s, see elongation_impulse */
  float sewn_gap;                   /* m */
  float seam_force;                 /* N/m, see seam_force */
  float doublings_per_step;         /* growth of seam_force per step */
  float closing_most;               /* 1/s, see closing_rate */
  float closing_speed;              /* m/s */
  int longest_seaming;              /* steps after which open joints are sewn anyway */
  int plane;                        /* from a component of a vector to the next */
  int spring_rows;                  /* from a direction's stiffnesses to the next one's */
  int joints;
  int joint_levels; /* joints of one level have no node in common */
  int joint_nodes;  /* different nodes of all joints, and the held ones */
  int held_nodes;   /* the first of these, which keep their height while the seams close */
};

/* A block: rows of a panel that one work-group handles. */
struct DressingBlock {
  int first; /* offset of its first node */
  int rows;
  int columns;
  int stride;            /* distance of two rows */
  int row;               /* number of its first row among the stiffnesses of a direction */
  int joins;             /* 1: the block before it is of the same panel */
  struct BodyFrame body; /* the body as seen by the panel's layer; no columns: no body */
  int first_pixel;
};

/* A joint: a node, drawn to the point `fraction` of the way from `first` to `second` (garment_laws.h). */
struct DressingJoint {
  int node; /* offsets of the three nodes */
  int first;
  int second;
  float fraction;
  float length;   /* m, of the seam that the joint represents */
  float strength; /* factor of the seam force */
};

/* Progress of a dressing. */
struct DressingState {
  int steps;
  int draping;   /* the seams are closed */
  int seamed_at; /* steps until then */
  int open_joints;
  int still_open; /* of those, the ones that the next step pulls together */
};

#endif
