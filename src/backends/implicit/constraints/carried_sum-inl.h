// x += h v of a small step, for floats, doubles and Lanes. Included inside a namespace that has mul_add for
// them, after MSSIM_INLINE (what makes a function inline there) is defined; it may be included again
// elsewhere, so it has no guard.

template <class Real>
MSSIM_INLINE void carry_sum(Real& x, Real& rest, Real h, Real v) {
  const Real moved = mul_add(h, v, rest);
  const Real sum = x + moved;
  rest = moved - (sum - x);
  x = sum;
}

/// Adds h v to the position x + rest, of which springs see x alone. A small step may move a node by less than
/// single precision rounds its position by: plain sums of such steps would drift, or stand still. What a sum
/// loses is exact, because x is larger (T. J. Dekker, 1971), and goes into the next one.
template <class Vector, class Real>
MSSIM_INLINE void carry_sum(Vector& x, Vector& rest, Real h, const Vector& v) {
  carry_sum(x.x, rest.x, h, v.x);
  carry_sum(x.y, rest.y, h, v.y);
  carry_sum(x.z, rest.z, h, v.z);
}
