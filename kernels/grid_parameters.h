/* What a grid's stage kernels are told about the cloth, in the common subset of C++ and OpenCL C: the host
 * fills this struct and the device reads it. All forces are per unit of node mass.
 */
struct GridParameters {
  int rows;
  int columns;
  float stiffness[3];      /* 1/s^2, by kind of spring */
  float stiffness_rest[3]; /* stiffness * rest length, m/s^2 */
  float damping[3];        /* 1/s */
  /* For grid_nodes.cl, where a work-item owns one node. */
  int stride; /* floats from one row to the next */
  int plane;  /* floats from one plane to the next */
  /* For grid_bands.cl, where it owns columns of several bands. */
  int height; /* rows of a band, at least 2 */
  int ghosts; /* columns on each side of a partition: two for each stage of a launch */
  int ring;   /* columns that a partition keeps of a pair other than the state, a power of two */
};
