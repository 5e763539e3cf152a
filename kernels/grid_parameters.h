/* What a grid's stage kernels are told about the cloth, in the common subset of C++ and OpenCL C: the host
 * fills this struct and the device reads it. All forces are per unit of node mass.
 *
 * Memory of a pair: six planes (x, y, z, u, v, w) of `plane` floats. Node (row, column) lies at
 *     (row + 2) * stride + 16 + column
 * of its plane, so that two rows above and below, and sixteen floats left of every row (which are also what
 * is right of the row before), can be read without asking whether there is a node.
 */
struct GridParameters {
  int rows;
  int columns;
  int stride;              /* floats from one row to the next, a multiple of 16 */
  int plane;               /* floats */
  int block_rows;          /* that a work-item walks over, where it has more than one lane */
  float stiffness[3];      /* 1/s^2, by kind of spring */
  float stiffness_rest[3]; /* stiffness * rest length, m/s^2 */
  float damping[3];        /* 1/s */
};
