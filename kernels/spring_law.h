/* The force of one spring, written once in the common subset of C++ and OpenCL C.
 *
 * Hooke's law with damping along the spring (the force f_i of Hong et al., Eq. 1):
 *
 *     f = (k (|d| - L) + c (u . d)/|d|) d/|d|,     d = x_other - x_this,  u = v_other - v_this,
 *
 * rearranged so that the force is `spring_pull(...) * d`: one reciprocal length and no unit vector.
 *
 * This file is text for many number types: it has no include guard, and whoever includes it first defines
 *   MSSIM_LAW                what stands before a function that returns a Real,
 *   mul_add(a, b, c)         a * b + c,
 *   inverse_sqrt(a)          1 / sqrt(a), both operations correctly rounded.
 */

/* Force on this end divided by the vector to the other end, N/m.
 * inverse_length = 1/|d| (1/m), closing = u . d (m^2/s), stiffness = k (N/m), stiffness_rest = k L (N),
 * damping = c (N s/m). */
MSSIM_LAW spring_pull_at(Real inverse_length, Real closing, Real stiffness, Real stiffness_rest,
                         Real damping) {
  return mul_add(mul_add(damping * closing, inverse_length, -stiffness_rest), inverse_length, stiffness);
}

/* The same from length_squared = d . d (m^2). A spring of length zero gives infinity or NaN, which the
 * callers' finite check reports. */
MSSIM_LAW spring_pull(Real length_squared, Real closing, Real stiffness, Real stiffness_rest, Real damping) {
  return spring_pull_at(inverse_sqrt(length_squared), closing, stiffness, stiffness_rest, damping);
}
