/* What the host tells kernels, in the common subset of C++ and OpenCL C: it fills these structs and the
 * device reads them. Needs spring_constants.h.
 */
#ifndef MSSIM_PARAMETERS
#define MSSIM_PARAMETERS
#ifndef __OPENCL_VERSION__
#include "kernels/spring_constants.h"
#endif

/* What acts on every node besides springs. */
struct Surroundings {
  float viscous_damping; /* 1/s */
  float gravity;         /* m/s^2, downwards */
  float floor_height;    /* m */
  float restitution;
  float friction;
};

/* What every stage kernel is told about the system and the integrator, whatever the topology. */
struct StepParameters {
  struct Surroundings surroundings;
  float coefficients[4][4][5]; /* of the integrator, [stage][assignment][term], dt included */
};

/* What a grid's stage kernels are told about the cloth. All forces are per unit of node mass. */
struct GridParameters {
  int rows;
  int columns;
  struct SpringFloats constants[3]; /* by kind of spring */
  float stiffness_rest[3];          /* stiffness * rest length, m/s^2 */
  /* For grid_nodes.cl, where a work-item owns one node. */
  int stride; /* floats from one row to the next */
  int plane;  /* floats from one plane to the next */
  /* For grid_bands.cl, where it owns columns of several bands. */
  int height; /* rows of a band, at least 2 */
  int ghosts; /* columns on each side of a partition: two for each stage of a launch */
  int ring;   /* columns that a partition keeps of a pair other than the state, a power of two */
};

/* How the work-items of a mesh's stage kernels share it. */
struct MeshParameters {
  unsigned tiles; /* of MSSIM_LANES nodes each */
  unsigned tiles_per_item;
};

/* Where the pixels of a body's maps (src/garment/contact/body_maps.h) lie and what one holds.
 *
 * Pixel (column, row) covers x from left + column / pixels_per_metre on and y from bottom + row /
 * pixels_per_metre on; row 0 is the lowest. Its record of BODY_FLOATS floats begins at
 * BODY_FLOATS * (row * columns + column): unit normal x y z and n . P of the front plane, then the same of
 * the back plane. Where there is no body both are 0 0 0 and -1e30, which no point is behind. The pixels along
 * the border hold none, so that points beside the maps read there what is right for them.
 */
struct BodyFrame {
  float left;   /* m, x of the left edge of column 0 */
  float bottom; /* m, y of the lower edge of row 0 */
  float pixels_per_metre;
  int columns;
  int rows;
};
#define BODY_FLOATS 8

/* A dressing. Offsets and distances are in floats. */

/* What acts on the nodes beside springs, joints and the body. */
struct DressingPhase {
  float damping; /* 1/s, per mass */
  float gravity; /* m/s^2, downwards */
  float friction;
};

struct DressingParameters {
  struct Surroundings surroundings; /* its floor */
  struct DressingPhase seaming;     /* until the seams are closed */
  struct DressingPhase draping;     /* from then on */
  float dt;                         /* s */
  float push_speed;                 /* m/s, see body_response */
  float correction_limit;           /* length over rest length, see elongation_excess */
  float correction_rate;            /* 1/s, see elongation_impulse */
  float sewn_gap;                   /* m */
  float seam_force;                 /* N/m, see seam_force */
  float doublings_per_step;         /* of that force */
  float closing_most;               /* 1/s, see closing_rate */
  float closing_speed;              /* m/s */
  int longest_seaming;              /* steps after which what is open is sewn as it is */
  int plane;                        /* from a component of a vector to the next */
  int spring_rows;                  /* from a direction's stiffnesses to the next one's */
  int joints;
  int joint_levels; /* joints of one level have no node in common */
  int joint_nodes;  /* the different nodes of all joints, and those that are held */
  int held_nodes;   /* of these the first, which keep their height while the seams close */
};

/* Rows of a panel that a work-group works on, and that one spring after the other is corrected in. */
struct DressingBlock {
  int first; /* float of its first node */
  int rows;
  int columns;
  int stride;            /* from one row to the next */
  int row;               /* of its first row the number among the stiffnesses of a direction */
  int joins;             /* 1: a block of the same panel stands before it */
  struct BodyFrame body; /* as the panel's layer meets it; no columns: nobody to dress */
  int first_pixel;
};

struct DressingJoint {
  int node;
  int first;
  int second;
  float fraction;
  float length; /* m */
  float strength;
};

/* How far it has come. */
struct DressingState {
  int steps;
  int draping;   /* the seams are closed */
  int seamed_at; /* steps after which that was so */
  int open_joints;
  int still_open; /* of those, what the next step draws together */
};

#endif
