// Vectors of nodes beside each other in a row of a cloth (row_layout.h), and their springs. Compiled once per
// instruction set, so the guard toggles.
#if defined(MSSIM_ROW_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MSSIM_ROW_LANES_INL_H_
#undef MSSIM_ROW_LANES_INL_H_
#else
#define MSSIM_ROW_LANES_INL_H_
#endif

#include <cstddef>
#include <cstdint>

#include "backends/vectors/lanes-inl.h"
#include "model/system.h"

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {

/// The springs of a node, each from the node: those of the stencil and, mirrored, those that end in it.
constexpr std::size_t node_springs = 2 * grid_stencil.size();
constexpr GridSpring spring_of_node(std::size_t i) {
  GridSpring spring = grid_stencil[i / 2];
  if (i % 2 == 1) {
    spring.rows = -spring.rows;
    spring.columns = -spring.columns;
  }
  return spring;
}

/// A vector of nodes in a row, where all their springs exist.
struct InnerVector {
  HWY_INLINE EveryLane has(int /*rows*/, int /*columns*/) const { return {}; }
};

/// A vector of nodes in a row, some of whose springs would end outside of the cloth, or some of whose lanes
/// lie there.
struct EdgeVector {
  std::uint32_t row;
  Index column;                 ///< of each lane
  std::uint32_t rows, columns;  ///< of the cloth
  /// Lanes that have a node in the cloth so many rows and columns further.
  HWY_INLINE Mask has(int down, int right) const {
    const bool row_exists = row + static_cast<std::uint32_t>(down) < rows;  // above the first it wraps
    return below(hn::Add(column, hn::Set(IndexTag(), static_cast<std::uint32_t>(right))),
                 row_exists ? columns : 0);
  }
};

/// Three components of a vector of nodes that need not begin where a vector does.
HWY_INLINE Lanes3 load_components(const float* from, std::ptrdiff_t pitch) {
  const FloatTag d;
  return {hn::LoadU(d, from), hn::LoadU(d, from + pitch), hn::LoadU(d, from + 2 * pitch)};
}

}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
