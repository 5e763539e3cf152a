// Springs and nodes of a vector in any layout, those of a row of a cloth (RowLayout), and the stages on them.
// Compiled once per instruction set, so the guard toggles.
#if defined(MSSIM_NODE_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MSSIM_NODE_LANES_INL_H_
#undef MSSIM_NODE_LANES_INL_H_
#else
#define MSSIM_NODE_LANES_INL_H_
#endif

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "backends/interface/backend.h"
#include "backends/layouts/node_arrays.h"
#include "backends/vectors/lanes-inl.h"
#include "model/system.h"

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {
inline namespace MSSIM_PRECISION {

/// Springs in registers.
using SpringLanes = LinearSpring<Lanes>;

/// The constants in every lane.
HWY_INLINE SpringConstants<Lanes> in_every_lane(const mssim::SpringConstants<Real>& constants) {
  return HWY_NAMESPACE::constants_from<Lanes>(std::identity(), constants);
}
HWY_INLINE SpringLanes in_every_lane(const mssim::LinearSpring<Real>& spring) {
  return {in_every_lane(spring.constants), spring.stiffness_rest};
}

/// Loads the constants of each lane, one vector per constant (write_constants). Advances `from` past them.
HWY_INLINE SpringConstants<Lanes> load_constants(const Real*& from) {
  const auto next = [&from]() MSSIM_INLINE_LAMBDA {
    const Lanes number = hn::Load(RealTag(), from);
    from += lane_count();
    return number;
  };
#define MSSIM_LOADED(name, info) next(),
  return {MSSIM_SPRING_CONSTANTS(MSSIM_LOADED)};
#undef MSSIM_LOADED
}

/// Parameters of a cloth in rows for every vector. A copy, because the compiler must assume that a vector
/// store may change any object in memory.
struct WalkedRows {
  SpringLanes spring[3];  ///< by GridSpringKind
  std::ptrdiff_t pitch;   ///< RowLayout::pitch
  HWY_INLINE WalkedRows(const std::vector<SpringPerMassOf<Real>>& springs, std::size_t of_layout)
      : spring{in_every_lane(springs[structural]), in_every_lane(springs[shear]),
               in_every_lane(springs[bending])},
        pitch(static_cast<std::ptrdiff_t>(of_layout)) {}
};

/// The springs of a node, each as seen from it: those of the stencil and, mirrored, those that end at it.
constexpr std::size_t node_springs = 2 * grid_stencil.size();
constexpr GridSpring spring_of_node(std::size_t i) {
  GridSpring spring = grid_stencil[i / 2];
  if (i % 2 == 1) {
    spring.rows = -spring.rows;
    spring.columns = -spring.columns;
  }
  return spring;
}

/// A vector of nodes in a row with all their springs.
struct InnerVector {
  HWY_INLINE EveryLane has(int /*rows*/, int /*columns*/) const { return {}; }
};

/// A vector of nodes in a row, where some springs or some lanes would be outside the cloth.
struct EdgeVector {
  std::uint32_t row;
  Index column;                 ///< of each lane
  std::uint32_t rows, columns;  ///< of the cloth
  /// Lanes with a node of the cloth at an offset of `down` rows and `right` columns.
  HWY_INLINE Mask has(int down, int right) const {
    const bool row_exists = row + static_cast<std::uint32_t>(down) < rows;  // above the first row it wraps
    return below(hn::Add(column, hn::Set(IndexTag(), static_cast<std::uint32_t>(right))),
                 row_exists ? columns : 0);
  }
};

/// Three components of a vector of nodes at an unaligned address.
HWY_INLINE Lanes3 load_components(const Real* from, auto pitch) {
  const RealTag d;
  return {hn::LoadU(d, from), hn::LoadU(d, from + pitch), hn::LoadU(d, from + 2 * pitch)};
}
/// The components x y z u v w of a vector of nodes at an unaligned address.
HWY_INLINE NodeLanes load_node(const Real* from, auto pitch) {
  return {load_components(from, pitch), load_components(from + 3 * pitch, pitch)};
}

/// Applies the floor to the new state of the nodes that are `free` (a Mask or EveryLane).
template <class Free>
HWY_INLINE void touch_floor(Free free, const SurroundingsOf<Real>& surroundings, Lanes3& x, Lanes3& v) {
  const Lanes height(surroundings.floor_height);
  touch_floor(both(free, hn::Lt(x.y.v, height.v)), height, Lanes(surroundings.restitution),
              Lanes(surroundings.friction), x, v);
}

/// One stage at the nodes of one vector. `pull`: the acceleration from the springs; `node`: the gathered
/// pair; nodes not `free` (a Mask or EveryLane) are unchanged. `gravity`, m/s^2, replaces that of
/// `surroundings`. `load` and `store` are update_stage's.
template <std::size_t method, std::size_t stage, class Free, class Load, class Store>
HWY_INLINE void update_lanes(const NodeLanes& node, const Lanes3& pull, Free free, Lanes gravity,
                             const Coefficients<Real>& coefficients, const SurroundingsOf<Real>& surroundings,
                             Load load, Store store) {
  // Held nodes are at rest; without acceleration every assignment returns their old value.
  const Lanes3 a = keep(free, node_acceleration(pull, node.v, Lanes(surroundings.viscous_damping), gravity));
  update_stage<method, stage>(coefficients, node.x, node.v, a, load, store,
                              [&](Lanes3& x, Lanes3& v)
                                  MSSIM_INLINE_LAMBDA { touch_floor(free, surroundings, x, v); });
}

}  // namespace MSSIM_PRECISION
}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
