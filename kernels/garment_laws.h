/* The laws of a garment besides springs, written once in the common subset of C++ and OpenCL C: a limit to
 * the elongation of its springs, and the joints of its seams.
 *
 * Text for many number types like spring_law.h; besides that file's names it needs
 *   square_root(a)   correctly rounded.
 */

/* Correction of over-elongated springs (Vassilev's loop 5): an impulse along the spring, on both of its ends,
 * after which they part no faster than the rule allows. */

/* Positive if a spring is longer than its limit (m): the difference of the squares (m^2). A limit of 0 means
 * that there is no spring. */
MSSIM_LAW elongation_excess(Real length_squared, Real limit) {
  Real none = limit - limit;
  return where_less(none, limit, length_squared - limit * limit, none);
}

/* For a spring longer than its limit: the impulse divided by the vector d to the other end, kg/s. This end's
 * velocity changes by `impulse * d / mass`, the other's by the opposite; 0 if the ends already approach fast
 * enough, or if neither can move.
 * closing = u . d (m^2/s), u the other end's velocity less this one's; rate_per_s: the fraction of the excess
 * length by which the ends must approach per second; mobility: sum of both inverse masses (1/kg), 0 if held.
 */
MSSIM_LAW elongation_impulse(Real length_squared, Real closing, Real limit, Real rate_per_s, Real mobility) {
  Real none = limit - limit;
  Real length = square_root(length_squared);
  Real parting = closing / length + rate_per_s * (length - limit); /* m/s, beyond what is allowed */
  Real impulse = parting / (mobility * length);
  impulse = where_less(none, parting, impulse, none);
  return where_less(none, mobility, impulse, none);
}

/* A joint has three nodes: a node, and the first and second node of the edge that it is sewn to, at the point
 * `fraction` of the way from first to second. If it is sewn to a node, that node is the first and the
 * fraction is 0. */

/* One coordinate of the vector from the node to the point that it is sewn to: of positions, its gap; of
 * velocities, the gap's rate. */
MSSIM_LAW joint_gap(Real node, Real first, Real second, Real fraction) {
  return first + fraction * (second - first) - node;
}

/* Velocity changes of the three nodes per impulse on the node, the opposite impulse on the point (1/kg). */
MSSIM_STRUCT(JointEnds) { Real node, first, second; };

/* Computes them from the nodes' inverse masses (1/kg). */
MSSIM_GIVES(JointEnds) joint_ends(Real fraction, Real node, Real first, Real second) {
  MSSIM_OF(JointEnds) ends;
  Real one = fraction - fraction + 1.0f;
  ends.node = node;
  ends.first = -(one - fraction) * first;
  ends.second = -fraction * second;
  return ends;
}

/* Change of the gap's rate per impulse, 1/kg; 0 if none of the three nodes can move. */
MSSIM_LAW joint_mobility(MSSIM_OF(JointEnds) ends, Real fraction) {
  Real one = fraction - fraction + 1.0f;
  return ends.node - ((one - fraction) * ends.first + fraction * ends.second);
}

/* The force that pulls an open joint together, N: independent of the gap, growing with time. per_metre:
 * initial force of the seam (N/m); doublings: time divided by the time in which the force grows by its
 * initial value; length: the part of the seam that the joint represents (m);
 * strength: factor of the joint (Joint::strength). */
MSSIM_LAW seam_force(Real per_metre, Real doublings, Real length, Real strength) {
  Real one = doublings - doublings + 1.0f;
  return per_metre * (one + doublings) * length * strength;
}

/* The fraction of its gap that a sewn joint closes per second (1/s): at most `most` (1/s), and no faster than
 * `speed` (m/s). distance: the gap's length (m). */
MSSIM_LAW closing_rate(Real distance, Real most, Real speed) {
  Real rate = speed / (distance + 1e-9f);
  return where_less(rate, most, rate, most);
}

/* One coordinate of the impulse after which a sewn joint's gap closes at that rate, without other motion. */
MSSIM_LAW closing_impulse(Real gap, Real gap_rate, Real rate, Real mobility) {
  Real one = gap - gap + 1.0f;
  return one / mobility * (gap_rate + rate * gap);
}
