// Loops 1, 2 and 4 of Algorithm 1 on rows of nodes side by side. Compiled once per instruction set
// (hwy/foreach_target.h), so the guard toggles.
#if defined(MSSIM_PANEL_FORCES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MSSIM_PANEL_FORCES_INL_H_
#undef MSSIM_PANEL_FORCES_INL_H_
#else
#define MSSIM_PANEL_FORCES_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "backends/layouts/records-inl.h"
#include "backends/vectors/lanes-inl.h"
#include "garment/contact/body_maps.h"
#include "garment/stepping/dressing_rules.h"
#include "garment/stepping/garment_grid.h"
#include "garment/stepping/panel_stencil.h"

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {

HWY_INLINE Lanes3 load(const Float3Arrays& a, std::size_t at) {
  return {hn::Load(FloatTag(), a.x.data() + at), hn::Load(FloatTag(), a.y.data() + at),
          hn::Load(FloatTag(), a.z.data() + at)};
}
HWY_INLINE Lanes3 load_unaligned(const Float3Arrays& a, std::size_t at) {
  return {hn::LoadU(FloatTag(), a.x.data() + at), hn::LoadU(FloatTag(), a.y.data() + at),
          hn::LoadU(FloatTag(), a.z.data() + at)};
}
HWY_INLINE void store(Float3Arrays& a, std::size_t at, const Lanes3& value) {
  hn::Store(value.x.v, FloatTag(), a.x.data() + at);
  hn::Store(value.y.v, FloatTag(), a.y.data() + at);
  hn::Store(value.z.v, FloatTag(), a.z.data() + at);
}

/// What holds for a whole step.
struct StepRule {
  float dt, push_speed;
  PhaseRule<float> phase;
  bool has_joints;
  bool layers_touch;  ///< before the body is met
};

/// Forces of the springs that the last rows own, on their own nodes, N: rows of floats in a ring of three
/// for each direction, with an empty vector on both sides.
class ForceScratch {
 public:
  explicit ForceScratch(const GarmentGrid& grid) {
    for (const GarmentGrid::Panel& panel : grid.panels) widest_ = std::max(widest_, panel.stride);
    widest_ += 2 * side;
    forces_ = Float3Arrays(panel_stencil.size() * rows * widest_);
  }
  /// Float of column 0 of a row's forces.
  HWY_INLINE std::size_t at(std::size_t direction, std::size_t row) const {
    return (direction * rows + row % rows) * widest_ + side;
  }
  void clear() {
    for (AlignedArray* array : {&forces_.x, &forces_.y, &forces_.z})
      std::fill(array->data(), array->data() + array->size(), 0.0F);
  }
  Float3Arrays& forces() { return forces_; }

 private:
  static constexpr std::size_t side = 16, rows = 3;
  std::size_t widest_ = 0;
  Float3Arrays forces_;
};

/// The forces of all springs that a row owns.
HWY_INLINE void compute_forces(const GarmentGrid& grid, const GarmentGrid::Panel& panel, std::size_t row,
                               ForceScratch& scratch) {
  for (std::size_t column = 0; column < panel.columns; column += lane_count()) {
    const std::size_t at = panel.first + row * panel.stride + column;
    const Lanes3 own = load(grid.position, at);
    for (std::size_t d = 0; d < panel_stencil.size(); ++d) {
      const std::ptrdiff_t offset =
          panel_stencil[d].rows * static_cast<std::ptrdiff_t>(panel.stride) + panel_stencil[d].columns;
      const Lanes3 away = load_unaligned(grid.position, at + static_cast<std::size_t>(offset)) - own;
      const Lanes rest = hn::Load(FloatTag(), grid.rest[d].data() + at);
      const Lanes stiffness(panel.stiffness[d][row]);
      const Lanes pull = spring_pull(dot(away, away), Lanes(0.0F), stiffness, stiffness * rest, Lanes(0.0F));
      const Mask exists = hn::Gt(rest.v, hn::Zero(FloatTag()));
      store(scratch.forces(), scratch.at(d, row) + column, keep(exists, pull * away));
    }
  }
}

/// The sum of all forces on a vector of nodes: of their own springs, and the opposite of those that other
/// nodes own.
HWY_INLINE Lanes3 force_on(ForceScratch& scratch, std::size_t row, std::size_t column) {
  Lanes3 sum = zero3();
  for (std::size_t d = 0; d < panel_stencil.size(); ++d) {
    sum = sum + load(scratch.forces(), scratch.at(d, row) + column);
    const std::size_t owner = row + 3 - static_cast<std::size_t>(panel_stencil[d].rows);
    sum = sum -
          load_unaligned(scratch.forces(),
                         static_cast<std::size_t>(static_cast<std::ptrdiff_t>(scratch.at(d, owner) + column) -
                                                  panel_stencil[d].columns));
  }
  return sum;
}

/// Loop 4's second half: what the body does to a vector of nodes. `x` is moved, `v` changed; returns those
/// that friction holds.
HWY_INLINE Mask touch_body(const BodyMaps& maps, const StepRule& rule, Mask real, Lanes3& x, Lanes3& v) {
  constexpr std::size_t lanes = hn::MaxLanes(FloatTag());
  const hn::RebindToSigned<FloatTag> index_tag;
  const BodyFrame& frame = maps.frame();
  const Lanes dt(rule.dt);
  const Lanes3 next = mul_add(dt, v, x);
  const auto whole = [&](Lanes coordinate, float first, int count) MSSIM_INLINE_LAMBDA {
    return hn::ConvertTo(index_tag, body_column(coordinate, Lanes(first), Lanes(frame.pixels_per_metre),
                                                Lanes(static_cast<float>(count - 1)))
                                        .v);
  };
  const auto column = whole(next.x, frame.left, frame.columns), row = whole(next.y, frame.bottom, frame.rows);
  HWY_ALIGN std::int32_t pixel[lanes];
  hn::Store(hn::Add(hn::Mul(row, hn::Set(index_tag, frame.columns)), column), index_tag, pixel);
  // Not gathered, which takes a look at the cache for each float, not for each pixel: 0.90 to 0.97 of the
  // time of a step on an Intel Xeon.
  const BodyPixel* const pixels = maps.pixels().data();
  const TransposedRecords<lanes> planes_of([&](std::size_t i)
                                               MSSIM_INLINE_LAMBDA { return &pixels[pixel[i]].front_x; });
  const BodyPlanes<Lanes> planes{planes_of.first(0), planes_of.first(1), planes_of.first(2),
                                 planes_of.first(3), planes_of.last(0),  planes_of.last(1),
                                 planes_of.last(2),  planes_of.last(3)};
  const BodyContact<Lanes> contact = body_contact(planes, next.x, next.y, next.z);
  const Mask inside = hn::And(real, hn::Lt(contact.distance.v, hn::Zero(FloatTag())));
  if (hn::AllFalse(FloatTag(), inside)) return inside;
  const ClothResponse<Lanes> after = body_response(ClothPoint<Lanes>{x.x, x.y, x.z, v.x, v.y, v.z}, contact,
                                                   Lanes(rule.phase.friction), Lanes(rule.push_speed), dt);
  x = select(inside, {after.x, after.y, after.z}, x);
  v = select(inside, {after.u, after.v, after.w}, v);
  return hn::And(inside, hn::Gt(after.stuck.v, hn::Zero(FloatTag())));
}

/// Loop 4's second half for a row of nodes: from moved positions and velocities to those after the body has
/// been met, and to what may still move.
HWY_INLINE void collide_with_body(GarmentGrid& grid, const GarmentGrid::Panel& panel, std::size_t row,
                                  const StepRule& rule) {
  for (std::size_t column = 0; column < panel.columns; column += lane_count()) {
    const std::size_t at = panel.first + row * panel.stride + column;
    Lanes free = hn::Load(FloatTag(), grid.inverse_mass.data() + at);
    if (panel.body != nullptr) {
      const Mask real = hn::Gt(free.v, hn::Zero(FloatTag()));
      Lanes3 x = load(grid.moved, at), v = load(grid.velocity, at);
      free = select(touch_body(*panel.body, rule, real, x, v), Lanes(0.0F), free);
      store(grid.velocity, at, v);
      store(grid.moved, at, x);
    }
    hn::Store(free.v, FloatTag(), grid.free.data() + at);
  }
}

/// Collides all rows of a block with the body.
HWY_INLINE void collide_with_body(GarmentGrid& grid, const GarmentGrid::Block& block, const StepRule& rule) {
  for (std::size_t row = block.begin; row < block.end; ++row)
    collide_with_body(grid, grid.panels[block.panel], row, rule);
}

/// Loops 1, 2 and 4 for the nodes of a block: from the positions of the block and of two rows on either side
/// to its velocities, its moved positions and what may still move; where layers touch, to its velocities. A
/// row meets the body in a loop of its own: with that, 0.88 to 0.96 of the time of a step before pixels were
/// loaded whole.
HWY_INLINE void update_velocities(GarmentGrid& grid, const GarmentGrid::Block& block, const StepRule& rule,
                                  ForceScratch& scratch) {
  const GarmentGrid::Panel& panel = grid.panels[block.panel];
  scratch.clear();
  const std::size_t before = std::min<std::size_t>(block.begin, 2);
  for (std::size_t row = block.begin - before; row < block.begin; ++row)
    compute_forces(grid, panel, row, scratch);
  const Lanes dt(rule.dt), gravity(rule.phase.gravity), damping(rule.phase.damping);
  for (std::size_t row = block.begin; row < block.end; ++row) {
    compute_forces(grid, panel, row, scratch);
    for (std::size_t column = 0; column < panel.columns; column += lane_count()) {
      const std::size_t at = panel.first + row * panel.stride + column;
      const Lanes inverse_mass = hn::Load(FloatTag(), grid.inverse_mass.data() + at);
      const Mask real = hn::Gt(inverse_mass.v, hn::Zero(FloatTag()));
      const Lanes3 v = load(grid.velocity, at);
      Lanes3 a =
          node_acceleration_unfused(inverse_mass * force_on(scratch, row, column), v, damping, gravity);
      if (rule.has_joints) a = a + load(grid.pull, at);
      store(grid.velocity, at, mul_add(dt, keep(real, a), v));
      store(grid.moved, at, load(grid.position, at));
    }
    if (!rule.layers_touch) collide_with_body(grid, panel, row, rule);
  }
}

}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
