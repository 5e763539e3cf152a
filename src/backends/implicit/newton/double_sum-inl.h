// Compiled once per instruction set, so the guard toggles.
#if defined(MSSIM_DOUBLE_SUM_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MSSIM_DOUBLE_SUM_INL_H_
#undef MSSIM_DOUBLE_SUM_INL_H_
#else
#define MSSIM_DOUBLE_SUM_INL_H_
#endif

#include "backends/vectors/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {

/// A sum of floats in double precision, lane by lane until the end.
class DoubleSum {
 public:
  HWY_INLINE DoubleSum() : low_(hn::Zero(Tag())), high_(hn::Zero(Tag())) {}
  HWY_INLINE void add(Lanes values) {
#if HWY_TARGET == HWY_SCALAR
    low_ = hn::Add(low_, hn::PromoteTo(Tag(), values.v));
#else
    const hn::Half<FloatTag> half;
    low_ = hn::Add(low_, hn::PromoteTo(Tag(), hn::LowerHalf(half, values.v)));
    high_ = hn::Add(high_, hn::PromoteTo(Tag(), hn::UpperHalf(half, values.v)));
#endif
  }
  HWY_INLINE double total() const { return hn::GetLane(hn::SumOfLanes(Tag(), hn::Add(low_, high_))); }

 private:
  using Tag = hn::Rebind<double, hn::Half<FloatTag>>;
  hn::Vec<Tag> low_, high_;
};

}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
