/* The constants of the law of a spring (spring_law.h), in the common subset of C++ and OpenCL C. They are
 * those of springs of one kind, and lie beside each other in this order wherever they are stored. The force
 * is linear in each of them, so that constants divided by a mass give accelerations. `spring_constants` in
 * src/model/system.h says what files call them.
 */
#ifndef MSSIM_SPRING_CONSTANTS

/* ROW(name) of each. */
#define MSSIM_SPRING_CONSTANTS(ROW) \
  ROW(stiffness) /* k, N/m */       \
  ROW(damping)   /* c, N s/m, along the spring */

#define MSSIM_NUMBER(name) spring_constant_##name,
enum { MSSIM_SPRING_CONSTANTS(MSSIM_NUMBER) spring_constant_count };

/* As the host gives them to kernels. */
#define MSSIM_FLOAT(name) float name;
struct SpringFloats {
  MSSIM_SPRING_CONSTANTS(MSSIM_FLOAT)
};

#endif
