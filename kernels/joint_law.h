/* What a joint of a seam does to the three nodes at its ends, written once in the common subset of C++ and
 * OpenCL C: a node, and the first and the second node of the edge that it is sewn to, at `fraction` of the
 * way from first to second. Where it is sewn to a node, that is the first, and the fraction 0.
 *
 * Text for many number types like body_contact.h.
 */

/* One coordinate of the way from the node to the point that it is sewn to; of positions its gap, of
 * velocities the gap's rate. */
MSSIM_LAW joint_gap(Real node, Real first, Real second, Real fraction) {
  return first + fraction * (second - first) - node;
}

/* By how much an impulse on the node, and its opposite on the point, change the velocities of the three, per
 * impulse (1/kg). */
MSSIM_STRUCT(JointEnds) { Real node, first, second; };

/* From their inverse masses. */
MSSIM_GIVES(JointEnds) joint_ends(Real fraction, Real node, Real first, Real second) {
  MSSIM_OF(JointEnds) ends;
  Real one = fraction - fraction + 1.0f;
  ends.node = node;
  ends.first = -(one - fraction) * first;
  ends.second = -fraction * second;
  return ends;
}

/* By how much an impulse changes the gap's rate, 1/kg; 0 where none of the three can move. */
MSSIM_LAW joint_mobility(MSSIM_OF(JointEnds) ends, Real fraction) {
  Real one = fraction - fraction + 1.0f;
  return ends.node - ((one - fraction) * ends.first + fraction * ends.second);
}

/* The force that draws an open joint together, N: of constant size while its gap closes, growing with time.
 * per_metre: the seam's at first (N/m); doublings: time over that in which it grows by its first value;
 * length: the share of the seam that the joint stands for (m). */
MSSIM_LAW seam_force(Real per_metre, Real doublings, Real length, Real strength) {
  Real one = doublings - doublings + 1.0f;
  return per_metre * (one + doublings) * length * strength;
}

/* The share of its gap that a sewn joint closes in a second; most: at most so much (1/s), and nowhere faster
 * than `speed` (m/s). distance: the gap's length (m). */
MSSIM_LAW closing_rate(Real distance, Real most, Real speed) {
  Real rate = speed / (distance + 1e-9f);
  return where_less(rate, most, rate, most);
}

/* One coordinate of the impulse after which a sewn joint's gap closes at that rate, and does nothing else. */
MSSIM_LAW closing_impulse(Real gap, Real gap_rate, Real rate, Real mobility) {
  Real one = gap - gap + 1.0f;
  return one / mobility * (gap_rate + rate * gap);
}
