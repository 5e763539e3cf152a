// One vector of floats, or with MSSIM_REAL of doubles, as a number type, on Highway: the widest of the
// current target's instruction set, up to 64 bytes. Compiled once per instruction set (hwy/foreach_target.h),
// so the guard toggles.
#if defined(MSSIM_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MSSIM_LANES_INL_H_
#undef MSSIM_LANES_INL_H_
#else
#define MSSIM_LANES_INL_H_
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>
#include <limits>

#include "backends/vectors/instruction_sets.h"
#include "integrators/coefficients.h"
#include "laws/host_laws.h"

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {
inline namespace MSSIM_PRECISION {

namespace hn = hwy::HWY_NAMESPACE;
using Real = MSSIM_REAL;
using RealTag = hn::CappedTag<Real, 64 / sizeof(Real)>;
using IndexTag = hn::RebindToUnsigned<RealTag>;
using Index = hn::Vec<IndexTag>;

#define MSSIM_INLINE HWY_INLINE
#define MSSIM_INLINE_LAMBDA HWY_ATTR __attribute__((always_inline))

/// Numbers in one vector, one per node.
struct Lanes {
  hn::Vec<RealTag> v;
  Lanes() = default;
  HWY_INLINE Lanes(hn::Vec<RealTag> value) : v(value) {}
  HWY_INLINE Lanes(Real value) : v(hn::Set(RealTag(), value)) {}
};

HWY_INLINE std::size_t lane_count() { return hn::Lanes(RealTag()); }

HWY_INLINE Lanes operator+(Lanes a, Lanes b) { return hn::Add(a.v, b.v); }
HWY_INLINE Lanes operator-(Lanes a, Lanes b) { return hn::Sub(a.v, b.v); }
HWY_INLINE Lanes operator*(Lanes a, Lanes b) { return hn::Mul(a.v, b.v); }
HWY_INLINE Lanes operator/(Lanes a, Lanes b) { return hn::Div(a.v, b.v); }
/// -a, not computed if a multiply-add can absorb it: those negate at no cost, and can then read `a` from
/// memory.
struct NegatedLanes {
  hn::Vec<RealTag> v;
  HWY_INLINE operator Lanes() const { return hn::Neg(v); }
};
HWY_INLINE NegatedLanes operator-(Lanes a) { return {a.v}; }
HWY_INLINE Lanes mul_add(Lanes a, Lanes b, Lanes c) { return hn::MulAdd(a.v, b.v, c.v); }
HWY_INLINE Lanes mul_add(Lanes a, Lanes b, NegatedLanes c) { return hn::MulSub(a.v, b.v, c.v); }
HWY_INLINE Lanes mul_add(NegatedLanes a, Lanes b, Lanes c) { return hn::NegMulAdd(a.v, b.v, c.v); }
HWY_INLINE Lanes square_root(Lanes a) { return hn::Sqrt(a.v); }
HWY_INLINE Lanes inverse_sqrt(Lanes a) { return hn::Div(hn::Set(RealTag(), Real{1}), hn::Sqrt(a.v)); }

/// Whether multiply-adds are rounded once. If they are rounded twice, results differ.
constexpr bool fuses = HWY_NATIVE_FMA != 0;

/// Whether inverse_length() is a root and a division, each correctly rounded.
#if HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX3
constexpr bool exact_roots = sizeof(Real) != sizeof(float);
#else
constexpr bool exact_roots = true;
#endif

/// The kernel for the current target's instruction set.
template <class Data>
StepKernel<Data> kernel_here(void (*step)(Data&, int)) {
  return {lane_count(), hwy::TargetName(HWY_TARGET), exact_roots, fuses, step};
}

/// a / 2 if that is neither zero nor denormal: decrements the exponent. An integer subtraction, because
/// multiplications limit the loops over springs: 0.97 to 0.99 of the time of a step on Zen 4.
HWY_INLINE Lanes halved(Lanes a) {
  using Bits = hn::TFromD<IndexTag>;
  constexpr Bits exponent_one = Bits{1} << (std::numeric_limits<Real>::digits - 1);
  return hn::BitCast(RealTag(), hn::Sub(hn::BitCast(IndexTag(), a.v), hn::Set(IndexTag(), exponent_one)));
}

/// 1 / sqrt(a) of a spring's length squared, for loops with little other work to overlap. A 512-bit root and
/// division keep their unit busy for 16 to 22 cycles (Zen 4, Sapphire Rapids). AVX-512 has an estimate of 14
/// bits, which one Newton step, y + y/2 (1 - a y^2), takes to 1.04 units in the last place (Zen 4); root and
/// division, each correctly rounded, come to 1.49. Step time of 500 x 700 relative to theirs: Sapphire Rapids
/// 0.74, Zen 4 0.95, Zen 5 1.00 to 1.03. The price: the estimate depends on the CPU, so results are bitwise
/// identical only between CPUs of the same design (Roots::exact avoids it). Other instruction sets estimate 8
/// to 12 bits, too few for one step, and one step is too few for doubles.
/// tests/backends/vectors/inverse_length_test.cpp checks the error for every mantissa. A template, because
/// Highway has the estimate for floats only: what is discarded is not compiled.
template <class Tag = RealTag>
HWY_INLINE Lanes inverse_length(Lanes length_squared) {
  if constexpr (exact_roots) {
    return inverse_sqrt(length_squared);
  } else {
    const hn::Vec<Tag> a = length_squared.v, y = hn::ApproximateReciprocalSqrt(a);
    const auto residual = hn::NegMulAdd(hn::Mul(a, y), y, hn::Set(Tag(), 1));
    return hn::MulAdd(halved(y).v, residual, y);
  }
}

HWY_INLINE Lanes where_less(Lanes a, Lanes b, Lanes yes, Lanes no) {
  return hn::IfThenElse(hn::Lt(a.v, b.v), yes.v, no.v);
}

using Mask = hn::Mask<RealTag>;
HWY_INLINE Lanes keep(Mask mask, Lanes a) { return hn::IfThenElseZero(mask, a.v); }
HWY_INLINE Lanes select(Mask mask, Lanes yes, Lanes no) { return hn::IfThenElse(mask, yes.v, no.v); }
/// Instead of a mask if all lanes are meant: nothing is computed.
struct EveryLane {};
HWY_INLINE Mask both(Mask a, Mask b) { return hn::And(a, b); }
HWY_INLINE Mask both(EveryLane, Mask mask) { return mask; }
HWY_INLINE Lanes keep(EveryLane, Lanes a) { return a; }
/// Lanes whose index is less than `limit`; false for an index that has wrapped below zero.
HWY_INLINE Mask below(Index index, std::uint32_t limit) {
  return hn::RebindMask(RealTag(), hn::Lt(index, hn::Set(IndexTag(), limit)));
}

/// Rotates: each lane gets the value of the lane `before` places earlier in `a`. In each `group` of lanes, a
/// power of two, lane `outside` gets the value of `other`.
HWY_INLINE Lanes from_lane(Lanes a, std::size_t before, std::size_t group, std::size_t outside, Lanes other) {
  const RealTag d;
  const auto set = [](std::size_t number)
                       HWY_ATTR { return hn::Set(IndexTag(), static_cast<hn::TFromD<IndexTag>>(number)); };
  const auto lane = hn::Iota(IndexTag(), 0);
  const auto source = hn::IndicesFromVec(d, hn::And(hn::Sub(lane, set(before)), set(hn::Lanes(d) - 1)));
  return hn::IfThenElse(hn::RebindMask(d, hn::Ne(hn::And(lane, set(group - 1)), set(outside))),
                        hn::TableLookupLanes(a.v, source), other.v);
}
/// Each lane gets the previous lane's value in `a`; the first one of each `group` gets that of `first`.
HWY_INLINE Lanes from_lane_before(Lanes a, Lanes first, std::size_t group) {
  return from_lane(a, 1, group, 0, first);
}
/// Each lane gets the next lane's value in `a`; the last one of each `group` gets that of `last`.
HWY_INLINE Lanes from_lane_behind(Lanes a, Lanes last, std::size_t group) {
  return from_lane(a, lane_count() - 1, group, group - 1, last);
}

/// Three components of a vector in space, one node per lane.
struct Lanes3 {
  Lanes x, y, z;
};
/// Positions (m) and velocities (m/s), one node per lane.
struct NodeLanes {
  Lanes3 x, v;
};
/// Loads components `pitch` numbers apart, each at an address aligned for vectors.
HWY_INLINE Lanes3 load3(const Real* from, auto pitch) {
  const RealTag d;
  return {hn::Load(d, from), hn::Load(d, from + pitch), hn::Load(d, from + 2 * pitch)};
}
HWY_INLINE Lanes3 load3(const Real* from) { return load3(from, lane_count()); }
HWY_INLINE void store3(Real* to, const Lanes3& a, auto pitch) {
  const RealTag d;
  hn::Store(a.x.v, d, to);
  hn::Store(a.y.v, d, to + pitch);
  hn::Store(a.z.v, d, to + 2 * pitch);
}
HWY_INLINE void store3(Real* to, const Lanes3& a) { store3(to, a, lane_count()); }
HWY_INLINE Lanes3 zero3() { return {Lanes(0.0F), Lanes(0.0F), Lanes(0.0F)}; }
HWY_INLINE Lanes3 operator+(const Lanes3& a, const Lanes3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
HWY_INLINE Lanes3 operator-(const Lanes3& a, const Lanes3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
HWY_INLINE Lanes3 operator*(Lanes s, const Lanes3& a) { return {s * a.x, s * a.y, s * a.z}; }
HWY_INLINE Lanes3 mul_add(Lanes s, const Lanes3& a, const Lanes3& b) {
  return {mul_add(s, a.x, b.x), mul_add(s, a.y, b.y), mul_add(s, a.z, b.z)};
}
HWY_INLINE Lanes3 mul_add(NegatedLanes s, const Lanes3& a, const Lanes3& b) {
  return {mul_add(s, a.x, b.x), mul_add(s, a.y, b.y), mul_add(s, a.z, b.z)};
}
HWY_INLINE Lanes3 keep(Mask mask, const Lanes3& a) {
  return {keep(mask, a.x), keep(mask, a.y), keep(mask, a.z)};
}
HWY_INLINE Lanes3 keep(EveryLane, const Lanes3& a) { return a; }
HWY_INLINE Lanes3 select(Mask mask, const Lanes3& yes, const Lanes3& no) {
  return {select(mask, yes.x, no.x), select(mask, yes.y, no.y), select(mask, yes.z, no.z)};
}
/// Shifts each component; the lane without a source gets `none`.
HWY_INLINE Lanes3 from_lane_before(const Lanes3& a, Lanes none, std::size_t group) {
  return {from_lane_before(a.x, none, group), from_lane_before(a.y, none, group),
          from_lane_before(a.z, none, group)};
}
HWY_INLINE Lanes3 from_lane_behind(const Lanes3& a, Lanes none, std::size_t group) {
  return {from_lane_behind(a.x, none, group), from_lane_behind(a.y, none, group),
          from_lane_behind(a.z, none, group)};
}
HWY_INLINE Lanes dot(const Lanes3& a, const Lanes3& b) {
  return mul_add(a.z, b.z, mul_add(a.y, b.y, a.x * b.x));
}
/// a . b + c, at no extra instructions with multiply-adds.
HWY_INLINE Lanes dot_add(const Lanes3& a, const Lanes3& b, Lanes c) {
  return mul_add(a.z, b.z, mul_add(a.y, b.y, mul_add(a.x, b.x, c)));
}

#define MSSIM_LAW_INLINE HWY_INLINE
#include "laws/laws-inl.h"

/// Applies the floor to the new state of the lanes `under` it (the other lanes are unchanged).
HWY_INLINE void touch_floor(Mask under, Lanes height, Lanes restitution, Lanes friction, Lanes3& x,
                            Lanes3& v) {
  if (HWY_LIKELY(hn::AllFalse(RealTag(), under))) return;
  x.y = select(under, height, x.y);
  v = select(under, floor_velocity(v, restitution, friction), v);
}

#include "integrators/stage_update-inl.h"

}  // namespace MSSIM_PRECISION
}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
