// How a small step moves a vector of nodes. Compiled once per instruction set, so the guard toggles.
#if defined(MSSIM_MOVE_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MSSIM_MOVE_LANES_INL_H_
#undef MSSIM_MOVE_LANES_INL_H_
#else
#define MSSIM_MOVE_LANES_INL_H_
#endif

#include "backends/interface/backend.h"
#include "backends/vectors/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {

#include "backends/implicit/constraints/carried_sum-inl.h"

/// Gravity and the damping of the air: v becomes (v - h g) / (1 + h c) where a node moves. `fall` = h g,
/// `kept` = 1 / (1 + h c).
HWY_INLINE Lanes3 fallen(Mask moves, const Lanes3& v, Lanes fall, Lanes kept) {
  return select(moves, Lanes3{kept * v.x, kept * (v.y - fall), kept * v.z}, v);
}

/// The floor, at the end of a step. What lies on it has no rest, which could be negative.
HWY_INLINE void meet_floor(Mask moves, const Surroundings& surroundings, NodeLanes& node, Lanes3& rest) {
  const auto height = hn::Set(FloatTag(), surroundings.floor_height);
  touch_floor(hn::And(moves, hn::Lt(node.x.y.v, height)), Lanes(height), Lanes(surroundings.restitution),
              Lanes(surroundings.friction), node.x, node.v);
  rest.y = keep(hn::Gt(node.x.y.v, height), rest.y);
}

}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
