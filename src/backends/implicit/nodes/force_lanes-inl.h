// Forces on a vector of nodes, of a cloth or of bodies. Compiled once per instruction set, so the guard
// toggles.
#if defined(MSSIM_FORCE_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MSSIM_FORCE_LANES_INL_H_
#undef MSSIM_FORCE_LANES_INL_H_
#else
#define MSSIM_FORCE_LANES_INL_H_
#endif

#include "backends/interface/backend.h"
#include "backends/vectors/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {

/// Accelerations (m/s^2) of a vector of nodes (RowVector, SliceVector) by their springs, the air and gravity,
/// at the positions (m) and velocities (m/s) of two fields. Also where a node is pinned.
template <class Vector>
HWY_INLINE Lanes3 acceleration_at(const Vector& vector, const float* x, const float* v,
                                  const Surroundings& surroundings) {
  const NodeLanes node{vector.load(x), vector.load(v)};
  Lanes3 pull = zero3();
  vector.for_each_spring([&](const auto& springs) MSSIM_INLINE_LAMBDA {
    const Lanes3 to_other = springs.load(x) - node.x;
    const Lanes factor = spring_pull_at(inverse_length(dot(to_other, to_other)),
                                        dot(springs.load(v) - node.v, to_other), springs.constants.stiffness,
                                        springs.constants.stiffness_rest, springs.constants.damping);
    pull = mul_add(keep(springs.exists, factor), to_other, pull);
  });
  return node_acceleration(pull, node.v, Lanes(surroundings.viscous_damping), Lanes(surroundings.gravity));
}

}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
