/* What the kernels of a dressing are told, in the common subset of C++ and OpenCL C: the host fills these
 * structs and the device reads them. Offsets and distances are in floats. Needs surroundings.h and
 * body_frame.h.
 */

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
  int joint_nodes;  /* the different nodes of all joints */
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
