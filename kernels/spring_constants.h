/* The constants of the law of a spring (spring_law.h), in the common subset of C++ and OpenCL C. All springs
 * of a kind share them, and they are always stored next to each other in this order. The force is linear in
 * each of them, so constants divided by a mass give accelerations.
 */
#ifndef MSSIM_SPRING_CONSTANTS

/* The TABLE: applies ROW(name, info) to each. info is for the host, which makes `spring_constants` in
 * src/model/system.h of it: the columns of SpringConstantInfo after the name. */
#define MSSIM_SPRING_CONSTANTS(ROW)                                                       \
  ROW(stiffness, /* k */                                                                  \
      (2, "N/m", "N m-1", "stiffness_n_per_m", "Force per lengthening, N/m.", 1e9, true)) \
  ROW(damping, /* c */                                                                    \
      (1, "N s/m", "N s m-1", "damping_n_s_per_m",                                        \
       "Force against the rate of lengthening, along the spring, N s/m.", 1e6, true))

#define MSSIM_NUMBER(name, info) spring_constant_##name,
enum { MSSIM_SPRING_CONSTANTS(MSSIM_NUMBER) spring_constant_count };

/* The constants in single precision, as the host passes them to kernels. */
#define MSSIM_FLOAT(name, info) float name;
struct SpringFloats {
  MSSIM_SPRING_CONSTANTS(MSSIM_FLOAT)
};

#endif
