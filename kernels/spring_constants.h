/* The constants of the law of a spring (spring_law.h), in the common subset of C++ and OpenCL C. All springs
 * of a kind share them, and they are always stored next to each other in this order. The force is linear in
 * each of them, so constants divided by a mass give accelerations. `spring_constants` in src/model/system.h
 * lists their names in files.
 */
#ifndef MSSIM_SPRING_CONSTANTS

/* Applies ROW(name) to each. */
#define MSSIM_SPRING_CONSTANTS(ROW) \
  ROW(stiffness) /* k, N/m */       \
  ROW(damping)   /* c, N s/m, along the spring */

#define MSSIM_NUMBER(name) spring_constant_##name,
enum { MSSIM_SPRING_CONSTANTS(MSSIM_NUMBER) spring_constant_count };

/* The constants in single precision, as the host passes them to kernels. */
#define MSSIM_FLOAT(name) float name;
struct SpringFloats {
  MSSIM_SPRING_CONSTANTS(MSSIM_FLOAT)
};

#endif
