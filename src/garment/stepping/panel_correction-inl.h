// Loop 5 of Algorithm 1 on rows of nodes side by side. Compiled once per instruction set
// (hwy/foreach_target.h), so the guard toggles.
//
// kernels/dressing.cl has the same loop over OpenCL C's vectors and, for a GPU, over lines of springs. The
// impulse is one text (kernels/elongation_law.h); Dressing.CorrectsInVectorsAsTheReferenceDoes and
// OpenclDressing.CorrectsInEverySweepAsSerialDoes hold both to the order of correction_order.h.
#if defined(MSSIM_PANEL_CORRECTION_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MSSIM_PANEL_CORRECTION_INL_H_
#undef MSSIM_PANEL_CORRECTION_INL_H_
#else
#define MSSIM_PANEL_CORRECTION_INL_H_
#endif

#include <hwy/highway.h>

#include <cstddef>

#include "garment/stepping/dressing_rules.h"
#include "garment/stepping/panel_forces-inl.h"
#include "laws/host_laws.h"

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {

/// Lanes with a spring longer than its limit.
HWY_INLINE Mask is_elongated(Lanes length_squared, Lanes limit) {
  return hn::Gt(elongation_excess(length_squared, limit).v, hn::Zero(FloatTag()));
}

/// The springs of a direction between two rows of nodes, a vector of them side by side: no two have a node in
/// common.
HWY_INLINE void correct_between_rows(GarmentGrid& grid, const GarmentGrid::Panel& panel, std::size_t row,
                                     std::size_t direction, const CorrectionRule<float>& rule) {
  const auto offset =
      static_cast<std::size_t>(static_cast<std::ptrdiff_t>(panel.stride) + panel_stencil[direction].columns);
  for (std::size_t column = 0; column < panel.columns; column += lane_count()) {
    const std::size_t at = panel.first + row * panel.stride + column, other = at + offset;
    const Lanes3 d = load_unaligned(grid.moved, other) - load(grid.moved, at);
    const Lanes squared = dot(d, d);
    const Lanes limit = Lanes(hn::Load(FloatTag(), grid.rest[direction].data() + at)) * Lanes(rule.limit);
    const Mask acts = is_elongated(squared, limit);
    if (HWY_LIKELY(hn::AllFalse(FloatTag(), acts))) continue;
    const Lanes own_free = hn::Load(FloatTag(), grid.free.data() + at);
    const Lanes other_free = hn::LoadU(FloatTag(), grid.free.data() + other);
    const Lanes3 own = load(grid.velocity, at), far = load_unaligned(grid.velocity, other);
    const Lanes impulse = keep(acts, elongation_impulse(squared, dot(far - own, d), limit,
                                                        Lanes(rule.rate_per_s), own_free + other_free));
    store(grid.velocity, at, mul_add(own_free * impulse, d, own));
    const Lanes3 after = far - (other_free * impulse) * d;
    hn::StoreU(after.x.v, FloatTag(), grid.velocity.x.data() + other);
    hn::StoreU(after.y.v, FloatTag(), grid.velocity.y.data() + other);
    hn::StoreU(after.z.v, FloatTag(), grid.velocity.z.data() + other);
  }
}

/// One spring of a row that is longer than its limit, from the node at a float to the next.
inline void correct_along_row(GarmentGrid& grid, std::size_t at, const CorrectionRule<float>& rule) {
  const Vec3<float> d = grid.moved.at(at + 1) - grid.moved.at(at);
  const Vec3<float> own = grid.velocity.at(at), far = grid.velocity.at(at + 1);
  const float own_free = grid.free.data()[at], far_free = grid.free.data()[at + 1];
  const float impulse =
      mssim::elongation_impulse(dot(d, d), dot(far - own, d), grid.rest[0].data()[at] * rule.limit,
                                rule.rate_per_s, own_free + far_free);
  grid.velocity.put(at, own + own_free * impulse * d);
  grid.velocity.put(at + 1, far - far_free * impulse * d);
}

/// The springs along a row, one after the other: a vector of them is looked at together, and those that are
/// too long, few mostly, are corrected in order.
HWY_INLINE void correct_row(GarmentGrid& grid, const GarmentGrid::Panel& panel, std::size_t row,
                            const CorrectionRule<float>& rule, bool forwards) {
  const std::size_t lanes = lane_count(), vectors = (panel.columns + lanes - 1) / lanes;
  for (std::size_t i = 0; i < vectors; ++i) {
    const std::size_t at = panel.first + row * panel.stride + lanes * (forwards ? i : vectors - 1 - i);
    const Lanes3 d = load_unaligned(grid.moved, at + 1) - load(grid.moved, at);
    const Lanes limit = Lanes(hn::Load(FloatTag(), grid.rest[0].data() + at)) * Lanes(rule.limit);
    const Mask acts = is_elongated(dot(d, d), limit);
    if (HWY_LIKELY(hn::AllFalse(FloatTag(), acts))) continue;
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(FloatTag(), acts, bits);
    for (std::size_t k = 0; k < lanes; ++k) {
      const std::size_t lane = forwards ? k : lanes - 1 - k;
      if ((bits[lane / 8] >> (lane % 8) & 1) != 0) correct_along_row(grid, at + lane, rule);
    }
  }
}

/// The springs within a block.
HWY_INLINE void correct_block(GarmentGrid& grid, const GarmentGrid::Block& block,
                              const CorrectionRule<float>& rule, bool forwards) {
  const GarmentGrid::Panel& panel = grid.panels[block.panel];
  for (std::size_t i = 0; i < limited_directions; ++i) {
    const std::size_t direction = forwards ? i : limited_directions - 1 - i;
    const std::size_t rows =
        block.end - block.begin - static_cast<std::size_t>(panel_stencil[direction].rows);
    for (std::size_t k = 0; k < rows; ++k) {
      const std::size_t row = block.begin + (forwards ? k : rows - 1 - k);
      if (direction == 0)
        correct_row(grid, panel, row, rule, forwards);
      else
        correct_between_rows(grid, panel, row, direction, rule);
    }
  }
}

/// The springs between a block and the one before it.
HWY_INLINE void correct_seam_of_blocks(GarmentGrid& grid, const GarmentGrid::Block& block,
                                       const CorrectionRule<float>& rule, bool forwards) {
  const GarmentGrid::Panel& panel = grid.panels[block.panel];
  for (std::size_t i = 1; i < limited_directions; ++i)
    correct_between_rows(grid, panel, block.begin - 1, forwards ? i : limited_directions - i, rule);
}

}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
