/* The law of a spring, written once in the common subset of C++ and OpenCL C: the force, and the quantities
 * derived from it.
 *
 * Text for many number types, without an include guard. Needs spring_constants.h; the includer first defines
 *   MSSIM_LAW                   prefix of a function that returns a Real,
 *   MSSIM_STRUCT(Name)          prefix of the braces of a struct of Reals,
 *   MSSIM_MEMBER(name)          a Real member of it,
 *   MSSIM_OF(Name)              the type,
 *   MSSIM_GIVES(Name)           prefix of a function that returns it,
 *   mul_add(a, b, c)            a * b + c,
 *   inverse_sqrt(a)             1 / sqrt(a), both operations correctly rounded,
 *   where_less(a, b, yes, no)   yes where a < b, else no.
 */

#define MSSIM_CONSTANT(name, info) MSSIM_MEMBER(name)
MSSIM_STRUCT(SpringConstants){MSSIM_SPRING_CONSTANTS(MSSIM_CONSTANT)};

/* A spring as the law needs it. stiffness_rest = k L (N): the rest length L enters only through it. */
MSSIM_STRUCT(LinearSpring) {
  MSSIM_OF(SpringConstants) constants;
  MSSIM_MEMBER(stiffness_rest)
};

/* Makes it from the constants and rest_length = L (m). */
MSSIM_GIVES(LinearSpring) linear_spring(MSSIM_OF(SpringConstants) constants, Real rest_length) {
  MSSIM_OF(LinearSpring) spring = {constants, constants.stiffness * rest_length};
  return spring;
}

/* Hooke's law with damping along the spring (the force f_i of Hong et al., Eq. 1):
 *
 *     f = (k (|d| - L) + c (u . d)/|d|) d/|d|,     d = x_other - x_this,  u = v_other - v_this,
 *
 * rearranged so that the force is `spring_pull(...) * d`: one reciprocal length and no unit vector.
 *
 * Force on this end divided by the vector to the other end, N/m.
 * inverse_length = 1/|d| (1/m), closing = u . d (m^2/s). */
MSSIM_LAW spring_pull_at(Real inverse_length, Real closing, MSSIM_OF(LinearSpring) spring) {
  return mul_add(mul_add(spring.constants.damping * closing, inverse_length, -spring.stiffness_rest),
                 inverse_length, spring.constants.stiffness);
}
/* Its floating-point operations: a product and two multiply-adds, which count as two each. */
enum { spring_pull_flops = 1 + 2 * 2 };

/* spring_pull_at for length_squared = d . d (m^2). A spring of length zero gives infinity or NaN, which the
 * callers' finite check reports. */
MSSIM_LAW spring_pull(Real length_squared, Real closing, MSSIM_OF(LinearSpring) spring) {
  return spring_pull_at(inverse_sqrt(length_squared), closing, spring);
}

/* The elastic energy of a spring of length `length` (m), J: zero at its rest length. */
MSSIM_LAW spring_energy(Real length, Real rest_length, MSSIM_OF(SpringConstants) constants) {
  Real stretch = length - rest_length;
  return 0.5f * constants.stiffness * stretch * stretch;
}

/* Power that a spring dissipates by its damping, W. */
MSSIM_LAW spring_loss(Real length_squared, Real closing, MSSIM_OF(SpringConstants) constants) {
  return constants.damping * closing * closing / length_squared;
}

/* The Jacobian: the derivatives of the force with respect to d and u. With n = d/|d|,
 *
 *     df/dd = k n n^T + k (1 - L/|d|) (I - n n^T),     df/du = c n n^T.
 *
 * The part of df/dd that comes from damping is omitted: it is not symmetric (Baraff and Witkin 1998, section
 * 4). Both are along n n^T + across (I - n n^T): positive definite if both factors are positive.
 */

/* `along` of df/dd, N/m; its `across` is negative if the spring is compressed. */
MSSIM_LAW spring_along(MSSIM_OF(LinearSpring) spring) { return spring.constants.stiffness; }
MSSIM_LAW spring_across(Real inverse_length, MSSIM_OF(LinearSpring) spring) {
  return mul_add(-spring.stiffness_rest, inverse_length, spring.constants.stiffness);
}

/* `across`, but 0 for a compressed spring, so that no sum of springs is indefinite. */
MSSIM_LAW spring_across_definite(Real inverse_length, MSSIM_OF(LinearSpring) spring) {
  Real none = spring.constants.stiffness - spring.constants.stiffness;
  Real across = spring_across(inverse_length, spring);
  return where_less(across, none, none, across);
}

/* `along` of df/du, N s/m; its `across` is 0. */
MSSIM_LAW spring_damping_along(MSSIM_OF(SpringConstants) constants) { return constants.damping; }

/* Contribution of a spring to the matrix of an implicit step of dt (s) along itself, kg: dt c + dt^2 k.
 * Across it the contribution is dt^2 spring_across_definite(...). */
MSSIM_LAW spring_step_along(Real dt, MSSIM_OF(SpringConstants) constants) {
  return dt * mul_add(dt, constants.stiffness, constants.damping);
}

#ifdef __OPENCL_VERSION__
/* A spring with equal parameters in every lane. */
MSSIM_INLINE struct LinearSpring spring_in_every_lane(struct SpringFloats constants, Real stiffness_rest) {
#define MSSIM_IN_EVERY_LANE(name, info) (Real)(constants.name),
  struct LinearSpring spring = {{MSSIM_SPRING_CONSTANTS(MSSIM_IN_EVERY_LANE)}, stiffness_rest};
  return spring;
}

/* Loads the constants of every lane, `step` floats from one constant to the next. */
MSSIM_INLINE struct SpringConstants load_constants(__global const float* from, size_t step) {
#define MSSIM_LOAD(name, info)         \
  constants.name = load_aligned(from); \
  from += step;
  struct SpringConstants constants;
  MSSIM_SPRING_CONSTANTS(MSSIM_LOAD)
  return constants;
}
#endif
