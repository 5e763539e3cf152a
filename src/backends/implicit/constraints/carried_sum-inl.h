// x += h v of a substep, for floats, doubles and Lanes. Include it inside a namespace that has mul_add for
// them, after defining MSSIM_INLINE (the prefix of inline functions). No include guard: it may be included
// several times.

/// Adds h v to one component, as below.
template <class Real>
MSSIM_INLINE void carry_sum(Real& x, Real& rest, Real h, Real v) {
  const Real moved = mul_add(h, v, rest);
  const Real sum = x + moved;
  rest = moved - (sum - x);
  x = sum;
}

/// Adds h v to the position x + rest, of which springs see only x. A substep may move a node by less than the
/// rounding error of its position in single precision: plain sums of such steps would drift or stall.
/// The rounding error of a sum is exact, because x is larger (T. J. Dekker, 1971), and is added to the next.
template <class Vector, class Real>
MSSIM_INLINE void carry_sum(Vector& x, Vector& rest, Real h, const Vector& v) {
  carry_sum(x.x, rest.x, h, v.x);
  carry_sum(x.y, rest.y, h, v.y);
  carry_sum(x.z, rest.z, h, v.z);
}
