/* What every stage kernel is told about the system and the integrator, whatever the topology, in the common
 * subset of C++ and OpenCL C: the host fills this struct and the device reads it.
 */
struct StepParameters {
  float viscous_damping; /* 1/s */
  float gravity;         /* m/s^2, downwards */
  float floor_height;    /* m */
  float restitution;
  float friction;
  float coefficients[4][4][5]; /* of the integrator, [stage][line][term], dt included */
};
