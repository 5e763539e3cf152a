/* The law of a spring, written once in the common subset of C++ and OpenCL C: the force, and what follows
 * from it.
 *
 * Hooke's law with damping along the spring (the force f_i of Hong et al., Eq. 1):
 *
 *     f = (k (|d| - L) + c (u . d)/|d|) d/|d|,     d = x_other - x_this,  u = v_other - v_this,
 *
 * rearranged so that the force is `spring_pull(...) * d`: one reciprocal length and no unit vector.
 *
 * Text for many number types: it has no include guard, needs spring_constants.h, and whoever includes it
 * first defines
 *   MSSIM_LAW                   what stands before a function that returns a Real,
 *   MSSIM_STRUCT(Name)          what stands before the braces of a struct of Reals,
 *   MSSIM_MEMBER(name)          a Real in it,
 *   MSSIM_OF(Name)              the type,
 *   MSSIM_GIVES(Name)           what stands before a function that returns it,
 *   mul_add(a, b, c)            a * b + c,
 *   inverse_sqrt(a)             1 / sqrt(a), both operations correctly rounded,
 *   where_less(a, b, yes, no)   yes where a < b, else no.
 */

MSSIM_STRUCT(SpringConstants){MSSIM_SPRING_CONSTANTS(MSSIM_MEMBER)};

/* A spring as the law takes it. stiffness_rest = k L (N): all that it takes of the rest length L. */
MSSIM_STRUCT(LinearSpring) {
  MSSIM_OF(SpringConstants) constants;
  MSSIM_MEMBER(stiffness_rest)
};

/* rest_length = L (m). */
MSSIM_GIVES(LinearSpring) linear_spring(MSSIM_OF(SpringConstants) constants, Real rest_length) {
  MSSIM_OF(LinearSpring) spring = {constants, constants.stiffness * rest_length};
  return spring;
}

/* Force on this end divided by the vector to the other end, N/m.
 * inverse_length = 1/|d| (1/m), closing = u . d (m^2/s). */
MSSIM_LAW spring_pull_at(Real inverse_length, Real closing, MSSIM_OF(LinearSpring) spring) {
  return mul_add(mul_add(spring.constants.damping * closing, inverse_length, -spring.stiffness_rest),
                 inverse_length, spring.constants.stiffness);
}

/* The same from length_squared = d . d (m^2). A spring of length zero gives infinity or NaN, which the
 * callers' finite check reports. */
MSSIM_LAW spring_pull(Real length_squared, Real closing, MSSIM_OF(LinearSpring) spring) {
  return spring_pull_at(inverse_sqrt(length_squared), closing, spring);
}

/* The energy that a spring of some length (m) holds, J: zero at its rest length. */
MSSIM_LAW spring_energy(Real length, Real rest_length, MSSIM_OF(SpringConstants) constants) {
  Real stretch = length - rest_length;
  return 0.5f * constants.stiffness * stretch * stretch;
}

/* What a spring takes of the energy by its damping, W. */
MSSIM_LAW spring_loss(Real length_squared, Real closing, MSSIM_OF(SpringConstants) constants) {
  return constants.damping * closing * closing / length_squared;
}

/* The Jacobian: how the force changes with d and u. With n = d/|d|,
 *
 *     df/dd = k n n^T + k (1 - L/|d|) (I - n n^T),     df/du = c n n^T.
 *
 * The part of df/dd that comes from damping is left out: it is not symmetric (Baraff and Witkin 1998,
 * section 4). So both are along n n^T + across (I - n n^T): positive definite where these two are positive.
 */

/* Of df/dd, N/m; across is below zero where the spring is compressed. */
MSSIM_LAW spring_along(MSSIM_OF(LinearSpring) spring) { return spring.constants.stiffness; }
MSSIM_LAW spring_across(Real inverse_length, MSSIM_OF(LinearSpring) spring) {
  return mul_add(-spring.stiffness_rest, inverse_length, spring.constants.stiffness);
}

/* across, but 0 for a compressed spring: no sum of springs is then indefinite. */
MSSIM_LAW spring_across_definite(Real inverse_length, MSSIM_OF(LinearSpring) spring) {
  Real none = spring.constants.stiffness - spring.constants.stiffness;
  Real across = spring_across(inverse_length, spring);
  return where_less(across, none, none, across);
}

/* Of df/du, N s/m, which has no across. */
MSSIM_LAW spring_damping_along(MSSIM_OF(SpringConstants) constants) { return constants.damping; }

/* What a spring adds to the matrix of an implicit step of dt (s) along itself, kg: dt c + dt^2 k. Across it
 * is dt^2 spring_across_definite(...). */
MSSIM_LAW spring_step_along(Real dt, MSSIM_OF(SpringConstants) constants) {
  return dt * mul_add(dt, constants.stiffness, constants.damping);
}

#ifdef __OPENCL_VERSION__
/* The same spring in every lane. */
MSSIM_INLINE struct LinearSpring spring_in_every_lane(struct SpringFloats constants, Real stiffness_rest) {
#define MSSIM_IN_EVERY_LANE(name) (Real)(constants.name),
  struct LinearSpring spring = {{MSSIM_SPRING_CONSTANTS(MSSIM_IN_EVERY_LANE)}, stiffness_rest};
  return spring;
}

/* Those of every lane, `step` floats from one constant to the next. */
MSSIM_INLINE struct SpringConstants load_constants(__global const float* from, size_t step) {
#define MSSIM_LOAD(name)               \
  constants.name = load_aligned(from); \
  from += step;
  struct SpringConstants constants;
  MSSIM_SPRING_CONSTANTS(MSSIM_LOAD)
  return constants;
}
#endif
