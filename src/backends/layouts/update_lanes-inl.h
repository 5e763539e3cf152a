// What a stage does with the nodes of one vector, however they lie in memory, once the springs' acceleration
// is known. Compiled once per instruction set, so the guard toggles.
#if defined(MSSIM_UPDATE_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MSSIM_UPDATE_LANES_INL_H_
#undef MSSIM_UPDATE_LANES_INL_H_
#else
#define MSSIM_UPDATE_LANES_INL_H_
#endif

#include "backends/interface/backend.h"
#include "backends/vectors/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {

/// One stage at the nodes of one vector. `pull`: the acceleration that the springs give them; `node`: what
/// they are in the gathered pair; those not `free` (a Mask or EveryLane) stay as they are. `gravity`, m/s^2,
/// in place of that of `surroundings`. `load` and `store` are update_stage's.
template <std::size_t method, std::size_t stage, class Free, class Load, class Store>
HWY_INLINE void update_lanes(const NodeLanes& node, const Lanes3& pull, Free free, Lanes gravity,
                             const Coefficients<float>& coefficients, const Surroundings& surroundings,
                             Load load, Store store) {
  // What is held is at rest; without acceleration every assignment gives it back as it was.
  const Lanes3 a = keep(free, node_acceleration(pull, node.v, Lanes(surroundings.viscous_damping), gravity));
  update_stage<method, stage>(
      coefficients, node.x, node.v, a, load, store, [&](Lanes3& x, Lanes3& v) MSSIM_INLINE_LAMBDA {
        const Lanes height(surroundings.floor_height);
        touch_floor(both(free, hn::Lt(x.y.v, height.v)), height, Lanes(surroundings.restitution),
                    Lanes(surroundings.friction), x, v);
      });
}

}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
