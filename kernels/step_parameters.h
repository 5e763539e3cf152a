/* What every stage kernel is told about the system and the integrator, whatever the topology, in the common
 * subset of C++ and OpenCL C: the host fills this struct and the device reads it.
 */
struct StepParameters {
  struct Surroundings surroundings;
  float coefficients[4][4][5]; /* of the integrator, [stage][assignment][term], dt included */
};
