// The sums of a substep, for floats, doubles and Lanes. Include it inside a namespace that has mul_add for
// them, after defining MSSIM_INLINE (the prefix of inline functions). No include guard: it may be included
// several times.
//
// A substep may change a position or a velocity by less than its rounding error in single precision: plain
// sums of such changes would drift or stall. So the rounding error of a sum, its rest, is added to the next
// change. The error is exact, because the sum is larger than the change (T. J. Dekker, 1971). Springs see
// only the rounded sums.

/// Adds `change`, which includes the rest of the sum before.
template <class Real>
MSSIM_INLINE void carry_sum(Real& sum, Real& rest, Real change) {
  const Real next = sum + change;
  rest = change - (next - sum);
  sum = next;
}

/// x += h v.
template <class Vector, class Real>
MSSIM_INLINE void carry_move(Vector& x, Vector& rest, Real h, const Vector& v) {
  carry_sum(x.x, rest.x, mul_add(h, v.x, rest.x));
  carry_sum(x.y, rest.y, mul_add(h, v.y, rest.y));
  carry_sum(x.z, rest.z, mul_add(h, v.z, rest.z));
}

/// sum + rest as their rounded sum and its error, whichever is larger (D. E. Knuth, 1969).
template <class Real>
MSSIM_INLINE void round_again(Real& sum, Real& rest) {
  const Real next = sum + rest, part = next - sum;
  rest = (sum - (next - part)) + (rest - part);
  sum = next;
}

/// Gravity and air damping, v = (v - h g) / (1 + h c): `lost` = h c / (1 + h c) and `fall` = h g / (1 + h c).
/// A factor 1 / (1 + h c) would be rounded to steps of 6e-8, or to 1. Springs have changed v since its sum
/// was rounded.
template <class Vector, class Real>
MSSIM_INLINE void carry_fall(Vector& v, Vector& rest, Real lost, Real fall) {
  round_again(v.x, rest.x);
  round_again(v.y, rest.y);
  round_again(v.z, rest.z);
  carry_sum(v.x, rest.x, mul_add(-lost, v.x, rest.x));
  carry_sum(v.y, rest.y, mul_add(-lost, v.y, rest.y - fall));
  carry_sum(v.z, rest.z, mul_add(-lost, v.z, rest.z));
}
