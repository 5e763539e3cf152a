// Algorithm 1 on vectors of nodes along rows. Compiled once per instruction set: hwy/foreach_target.h
// includes this file again for each.
#include "backends/vectors/instruction_sets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "garment/stepping/step_panels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>

#include "backends/layouts/records-inl.h"
#include "backends/threads/spin_barrier.h"
#include "backends/vectors/lanes-inl.h"
#include "garment/contact/body_maps.h"
#include "garment/stepping/step_panels.h"
#include "laws/host_laws.h"

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {

HWY_INLINE Lanes3 load(const Float3Arrays& a, std::size_t at) {
  return {hn::Load(RealTag(), a.x.data() + at), hn::Load(RealTag(), a.y.data() + at),
          hn::Load(RealTag(), a.z.data() + at)};
}
HWY_INLINE Lanes3 load_unaligned(const Float3Arrays& a, std::size_t at) {
  return {hn::LoadU(RealTag(), a.x.data() + at), hn::LoadU(RealTag(), a.y.data() + at),
          hn::LoadU(RealTag(), a.z.data() + at)};
}
HWY_INLINE void store(Float3Arrays& a, std::size_t at, const Lanes3& value) {
  hn::Store(value.x.v, RealTag(), a.x.data() + at);
  hn::Store(value.y.v, RealTag(), a.y.data() + at);
  hn::Store(value.z.v, RealTag(), a.z.data() + at);
}

/// Constants of a step.
struct StepRule {
  float dt, push_speed;
  PhaseRule<float> phase;
  bool has_joints;
  bool layers_touch;  ///< then the body comes after the collision of layers
};

/// Forces, N, of the springs that the last rows own, on their owners: for each direction a ring of three rows
/// of floats, with an empty vector on both sides.
class ForceScratch {
 public:
  explicit ForceScratch(const GarmentGrid& grid) {
    for (const GarmentGrid::Panel& panel : grid.panels) widest_ = std::max(widest_, panel.stride);
    widest_ += 2 * side;
    forces_ = Float3Arrays(panel_stencil.size() * rows * widest_);
  }
  /// Index of the float of column 0 of a row's forces.
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

/// Computes the forces of all springs that a row owns.
HWY_INLINE void compute_forces(const GarmentGrid& grid, const GarmentGrid::Panel& panel, std::size_t row,
                               ForceScratch& scratch) {
  for (std::size_t column = 0; column < panel.columns; column += lane_count()) {
    const std::size_t at = panel.first + row * panel.stride + column;
    const Lanes3 own = load(grid.position, at);
    for (std::size_t d = 0; d < panel_stencil.size(); ++d) {
      const std::ptrdiff_t offset =
          panel_stencil[d].rows * static_cast<std::ptrdiff_t>(panel.stride) + panel_stencil[d].columns;
      const Lanes3 away = load_unaligned(grid.position, at + static_cast<std::size_t>(offset)) - own;
      const Lanes rest = hn::Load(RealTag(), grid.rest[d].data() + at);
      const SpringConstants<Lanes> undamped{.stiffness = Lanes(panel.stiffness[d][row]),
                                            .damping = Lanes(0.0F)};
      const Lanes pull = spring_pull(dot(away, away), Lanes(0.0F), linear_spring(undamped, rest));
      const Mask exists = hn::Gt(rest.v, hn::Zero(RealTag()));
      store(scratch.forces(), scratch.at(d, row) + column, keep(exists, pull * away));
    }
  }
}

/// The sum of all forces on a vector of nodes: those of the springs that they own, less those of the springs
/// that end at them.
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

/// Second half of loop 4: contact of a vector of nodes with the body. Changes `x` and `v`; returns the nodes
/// that friction holds.
HWY_INLINE Mask touch_body(const BodyMaps& maps, const StepRule& rule, Mask real, Lanes3& x, Lanes3& v) {
  constexpr std::size_t lanes = hn::MaxLanes(RealTag());
  const hn::RebindToSigned<RealTag> index_tag;
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
  // Not gathered: a gather accesses the cache per float, not per pixel. Steps took 0.90 to 0.97 of the time
  // on an Intel Xeon.
  const BodyPixel* const pixels = maps.pixels().data();
  const TransposedRecords<lanes> planes_of([&](std::size_t i)
                                               MSSIM_INLINE_LAMBDA { return &pixels[pixel[i]].front_x; });
  const BodyPlanes<Lanes> planes{planes_of.first(0), planes_of.first(1), planes_of.first(2),
                                 planes_of.first(3), planes_of.last(0),  planes_of.last(1),
                                 planes_of.last(2),  planes_of.last(3)};
  const BodyContact<Lanes> contact = body_contact(planes, next.x, next.y, next.z);
  const Mask inside = hn::And(real, hn::Lt(contact.distance.v, hn::Zero(RealTag())));
  if (hn::AllFalse(RealTag(), inside)) return inside;
  const ClothResponse<Lanes> after = body_response(ClothPoint<Lanes>{x.x, x.y, x.z, v.x, v.y, v.z}, contact,
                                                   Lanes(rule.phase.friction), Lanes(rule.push_speed), dt);
  x = select(inside, {after.x, after.y, after.z}, x);
  v = select(inside, {after.u, after.v, after.w}, v);
  return hn::And(inside, hn::Gt(after.stuck.v, hn::Zero(RealTag())));
}

/// Second half of loop 4 for a row of nodes: applies contact with the body to moved positions and velocities,
/// and sets `free`.
HWY_INLINE void collide_with_body(GarmentGrid& grid, const GarmentGrid::Panel& panel, std::size_t row,
                                  const StepRule& rule) {
  for (std::size_t column = 0; column < panel.columns; column += lane_count()) {
    const std::size_t at = panel.first + row * panel.stride + column;
    Lanes free = hn::Load(RealTag(), grid.inverse_mass.data() + at);
    if (panel.body != nullptr) {
      const Mask real = hn::Gt(free.v, hn::Zero(RealTag()));
      Lanes3 x = load(grid.moved, at), v = load(grid.velocity, at);
      free = select(touch_body(*panel.body, rule, real, x, v), Lanes(0.0F), free);
      store(grid.velocity, at, v);
      store(grid.moved, at, x);
    }
    hn::Store(free.v, RealTag(), grid.free.data() + at);
  }
}

/// Loops 1, 2 and 4 for the nodes of a block: computes its velocities, moved positions and `free` from the
/// positions of the block and of two rows on each side. If layers touch, contact with the body follows later.
/// It has its own loop per row: steps took 0.88 to 0.96 of the time, before pixels were loaded whole.
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
      const Lanes inverse_mass = hn::Load(RealTag(), grid.inverse_mass.data() + at);
      const Mask real = hn::Gt(inverse_mass.v, hn::Zero(RealTag()));
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

// Loop 5. kernels/dressing.cl has the same loop over OpenCL C's vectors and, for a GPU, over lines of
// springs. Both use the impulse of kernels/garment_laws.h. Dressing.CorrectsInVectorsAsTheReferenceDoes and
// OpenclDressing.CorrectsInEverySweepAsSerialDoes compare both with correction_order.

/// Lanes with a spring longer than its limit.
HWY_INLINE Mask is_elongated(Lanes length_squared, Lanes limit) {
  return hn::Gt(elongation_excess(length_squared, limit).v, hn::Zero(RealTag()));
}

/// Corrects the springs of a direction between two rows of nodes, a vector at a time: no two have a common
/// node.
HWY_INLINE void correct_between_rows(GarmentGrid& grid, const GarmentGrid::Panel& panel, std::size_t row,
                                     std::size_t direction, const CorrectionRule<float>& rule) {
  const auto offset =
      static_cast<std::size_t>(static_cast<std::ptrdiff_t>(panel.stride) + panel_stencil[direction].columns);
  for (std::size_t column = 0; column < panel.columns; column += lane_count()) {
    const std::size_t at = panel.first + row * panel.stride + column, other = at + offset;
    const Lanes3 d = load_unaligned(grid.moved, other) - load(grid.moved, at);
    const Lanes squared = dot(d, d);
    const Lanes limit = Lanes(hn::Load(RealTag(), grid.rest[direction].data() + at)) * Lanes(rule.limit);
    const Mask acts = is_elongated(squared, limit);
    if (HWY_LIKELY(hn::AllFalse(RealTag(), acts))) continue;
    const Lanes own_free = hn::Load(RealTag(), grid.free.data() + at);
    const Lanes other_free = hn::LoadU(RealTag(), grid.free.data() + other);
    const Lanes3 own = load(grid.velocity, at), far = load_unaligned(grid.velocity, other);
    const Lanes impulse = keep(acts, elongation_impulse(squared, dot(far - own, d), limit,
                                                        Lanes(rule.rate_per_s), own_free + other_free));
    store(grid.velocity, at, mul_add(own_free * impulse, d, own));
    const Lanes3 after = far - (other_free * impulse) * d;
    hn::StoreU(after.x.v, RealTag(), grid.velocity.x.data() + other);
    hn::StoreU(after.y.v, RealTag(), grid.velocity.y.data() + other);
    hn::StoreU(after.z.v, RealTag(), grid.velocity.z.data() + other);
  }
}

/// Corrects a spring of a row that is longer than its limit, from the node at a float to the next.
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

/// Corrects the springs along a row: tests a vector of them at once, then corrects those that are too long,
/// usually few, one after the other.
HWY_INLINE void correct_row(GarmentGrid& grid, const GarmentGrid::Panel& panel, std::size_t row,
                            const CorrectionRule<float>& rule, bool forwards) {
  const std::size_t lanes = lane_count(), vectors = (panel.columns + lanes - 1) / lanes;
  for (std::size_t i = 0; i < vectors; ++i) {
    const std::size_t at = panel.first + row * panel.stride + lanes * (forwards ? i : vectors - 1 - i);
    const Lanes3 d = load_unaligned(grid.moved, at + 1) - load(grid.moved, at);
    const Lanes limit = Lanes(hn::Load(RealTag(), grid.rest[0].data() + at)) * Lanes(rule.limit);
    const Mask acts = is_elongated(dot(d, d), limit);
    if (HWY_LIKELY(hn::AllFalse(RealTag(), acts))) continue;
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(RealTag(), acts, bits);
    for (std::size_t k = 0; k < lanes; ++k) {
      const std::size_t lane = forwards ? k : lanes - 1 - k;
      if ((bits[lane / 8] >> (lane % 8) & 1) != 0) correct_along_row(grid, at + lane, rule);
    }
  }
}

/// Corrects the springs within a block.
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

/// Corrects the springs between a block and the one before it.
HWY_INLINE void correct_seam_of_blocks(GarmentGrid& grid, const GarmentGrid::Block& block,
                                       const CorrectionRule<float>& rule, bool forwards) {
  const GarmentGrid::Panel& panel = grid.panels[block.panel];
  for (std::size_t i = 1; i < limited_directions; ++i)
    correct_between_rows(grid, panel, block.begin - 1, forwards ? i : limited_directions - i, rule);
}

/// Blocks of one thread.
struct BlockRange {
  std::size_t begin, end;
};

/// Loop 6 for a block.
HWY_INLINE void move_block(GarmentGrid& grid, const GarmentGrid::Block& block, Lanes dt, const Floor& floor) {
  const GarmentGrid::Panel& panel = grid.panels[block.panel];
  const std::size_t first = panel.first + block.begin * panel.stride;
  const std::size_t last = panel.first + block.end * panel.stride;
  const Lanes height(static_cast<float>(floor.height));
  for (std::size_t at = first; at < last; at += lane_count()) {
    Lanes3 v = load(grid.velocity, at), x = mul_add(dt, v, load(grid.moved, at));
    const Mask real = hn::Gt(hn::Load(RealTag(), grid.inverse_mass.data() + at), hn::Zero(RealTag()));
    const Mask under = hn::And(real, hn::Lt(x.y.v, height.v));
    touch_floor(under, height, Lanes(static_cast<float>(floor.restitution)),
                Lanes(static_cast<float>(floor.friction)), x, v);
    store(grid.position, at, x);
    store(grid.velocity, at, v);
  }
}

/// Corrects over-elongated springs in the order of correction_order: a thread's own blocks, and the springs
/// between each of them and the previous block. The barrier separates the two.
HWY_INLINE void correct(GarmentGrid& grid, const CorrectionRule<float>& rule, std::uint32_t sweeps,
                        BlockRange range, SpinBarrier& barrier) {
  for (std::uint32_t sweep = 0; sweep < sweeps; ++sweep) {
    const bool forwards = sweep % 2 == 0;
    if (forwards) {
      for (std::size_t b = range.begin; b < range.end; ++b) correct_block(grid, grid.blocks[b], rule, true);
      barrier.wait();
    }
    for (std::size_t b = range.begin; b < range.end; ++b)
      if (grid.blocks[b].begin != 0) correct_seam_of_blocks(grid, grid.blocks[b], rule, forwards);
    if (!forwards) {
      barrier.wait();
      for (std::size_t b = range.begin; b < range.end; ++b) correct_block(grid, grid.blocks[b], rule, false);
    }
  }
}

/// A thread of a team, its blocks and its scratch memory.
struct Worker : Team {
  Worker(const Team& team, const PanelDressing& dressing, ForceScratch& its)
      : Team(team),
        range{team.begin(dressing.grid.blocks.size()), team.end(dressing.grid.blocks.size())},
        scratch(its) {}

  BlockRange range;
  ForceScratch& scratch;
};

StepRule step_rule(const PanelDressing& dressing) {
  const DressingSettings& rules = dressing.garment.dressing;
  const bool draping = dressing.seaming.progress.draping;
  return {static_cast<float>(dressing.dt_s), static_cast<float>(rules.push_speed),
          phase_rule<float>(dressing.system, rules, draping), !draping, dressing.layers.has_value()};
}

/// Loops 1 to 4, up to the collision of layers.
void accelerate(PanelDressing& dressing, const Worker& worker) {
  const StepRule rule = step_rule(dressing);
  if (rule.has_joints) {
    if (worker.thread == 0) pull_joints(dressing);
    worker.meet();
  }
  for (std::size_t b = worker.range.begin; b < worker.range.end; ++b)
    update_velocities(dressing.grid, dressing.grid.blocks[b], rule, worker.scratch);
}

/// The rest of a step.
void move(PanelDressing& dressing, const Worker& worker) {
  GarmentGrid& grid = dressing.grid;
  const DressingSettings& rules = dressing.garment.dressing;
  const BlockRange range = worker.range;
  const StepRule rule = step_rule(dressing);
  if (rule.layers_touch)
    for (std::size_t b = range.begin; b < range.end; ++b)
      for (std::size_t row = grid.blocks[b].begin; row < grid.blocks[b].end; ++row)
        collide_with_body(grid, grid.panels[grid.blocks[b].panel], row, rule);
  const std::uint32_t sweeps = correction_sweeps(rules);
  if (sweeps == 0) worker.meet();
  correct(grid, correction_rule<float>(rules, dressing.dt_s), sweeps, range, worker.barrier);
  worker.meet();
  if (worker.thread == 0) {
    close_sewn_joints(dressing);
    dressing.seaming.end_step(rules, dressing.dt_s);
  }
  worker.meet();
  for (std::size_t b = range.begin; b < range.end; ++b)
    move_block(grid, grid.blocks[b], Lanes(rule.dt), dressing.system.floor);
}

/// Collides the layers of the garment.
void collide_layers(PanelDressing& dressing) {
  GarmentGrid& grid = dressing.grid;
  dressing.layers->collide(
      dressing.dt_s,
      [&](std::size_t node) {
        const std::size_t at = grid.offset[node];
        return NodeState{grid.moved.at(at), grid.velocity.at(at)};
      },
      [&](std::size_t node, const NodeState& state) {
        grid.moved.put(grid.offset[node], state.position);
        grid.velocity.put(grid.offset[node], state.velocity);
      });
}

/// A step, until this thread has moved its own nodes.
void take_step(PanelDressing& dressing, const Worker& worker) {
  accelerate(dressing, worker);
  if (dressing.layers) {
    worker.meet();
    if (worker.thread == 0) collide_layers(dressing);
    worker.meet();
  }
  move(dressing, worker);
}

void step_panels(PanelDressing& dressing, int count) {
  // One for each thread, and one for a thread that does the work of all.
  std::vector<std::optional<ForceScratch>> scratch(dressing.threads + 1);
  const auto worker_of = [&](const Team& team, std::size_t number) {
    if (!scratch[number]) scratch[number].emplace(dressing.grid);
    return Worker(team, dressing, *scratch[number]);
  };
  if (!dressing.layers || dressing.layers->threads() == 1) {
    SpinBarrier no_barrier(1);
    const auto step_alone = [&](std::size_t step) {
      if (step >= static_cast<std::size_t>(count)) return false;
      take_step(dressing, worker_of({0, 1, no_barrier}, dressing.threads));
      return true;
    };
    const std::size_t begin = dressing.team_gain.take_rounds(step_alone);
    if (begin == static_cast<std::size_t>(count)) return;
    const auto take_steps = [&](const Team& team) {
      const Worker worker = worker_of(team, team.thread);
      for (std::size_t step = begin; step < static_cast<std::size_t>(count); ++step) {
        take_step(dressing, worker);
        step += team.end_round([&](std::size_t taken) { return step_alone(step + 1 + taken); });
      }
    };
    with_team(dressing.threads, take_steps, dressing.team_gain);
    return;
  }
  // The threads of the collision are a separate team.
  for (int step = 0; step < count; ++step) {
    with_team(dressing.threads,
              [&](const Team& team) { accelerate(dressing, worker_of(team, team.thread)); });
    collide_layers(dressing);
    with_team(dressing.threads, [&](const Team& team) { move(dressing, worker_of(team, team.thread)); });
  }
}

StepKernel<PanelDressing> panel_kernel() { return kernel_here(&step_panels); }

}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mssim {
MSSIM_COMPILED_KERNELS(PanelDressing, panel_kernel)
}  // namespace mssim
#endif
