/* What keeps an over-elongated spring from growing (Vassilev's loop 5), written once in the common subset of
 * C++ and OpenCL C: an impulse along the spring, on both its ends, after which they part no faster than the
 * rule allows.
 *
 * Text for many number types like floor_law.h; beyond that file's names it needs
 *   square_root(a)   correctly rounded.
 */

/* Positive where a spring is longer than its limit (m): the difference of the squares (m^2). A limit of 0
 * means that there is no spring. */
MSSIM_LAW elongation_excess(Real length_squared, Real limit) {
  Real none = limit - limit;
  return where_less(none, limit, length_squared - limit * limit, none);
}

/* For a spring longer than its limit: the impulse divided by the vector d to the other end, kg/s. This end's
 * velocity changes by `impulse * d / mass`, the other's by the opposite; 0 where the ends approach as they
 * shall, or where neither can move.
 * closing = u . d (m^2/s), u the other end's velocity less this one's; rate_per_s: the share of what the
 * spring is longer than its limit that the ends must approach by in a second; mobility: the sum of both ends'
 * inverse masses (1/kg), 0 for an end that is held. */
MSSIM_LAW elongation_impulse(Real length_squared, Real closing, Real limit, Real rate_per_s, Real mobility) {
  Real none = limit - limit;
  Real length = square_root(length_squared);
  Real parting = closing / length + rate_per_s * (length - limit); /* m/s, beyond what is allowed */
  Real impulse = parting / (mobility * length);
  impulse = where_less(none, parting, impulse, none);
  return where_less(none, mobility, impulse, none);
}
