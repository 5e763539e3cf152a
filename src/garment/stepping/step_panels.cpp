// Compiled once per instruction set: hwy/foreach_target.h includes this file again for each.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "garment/stepping/step_panels.cpp"
#include "garment/stepping/step_panels.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "backends/threads/spin_barrier.h"
#include "garment/stepping/panel_correction-inl.h"
#include "garment/stepping/panel_forces-inl.h"
#include "garment/stepping/panel_joints.h"

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {

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
    const Mask real = hn::Gt(hn::Load(FloatTag(), grid.inverse_mass.data() + at), hn::Zero(FloatTag()));
    const Mask under = hn::And(real, hn::Lt(x.y.v, height.v));
    touch_floor(under, height, Lanes(static_cast<float>(floor.restitution)),
                Lanes(static_cast<float>(floor.friction)), x, v);
    store(grid.position, at, x);
    store(grid.velocity, at, v);
  }
}

/// Limits what over-elongated springs do, in the order of correction_order.h: a thread's own blocks, and the
/// springs between each of them and the block before it, which is done when all have passed the barrier.
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

/// What the first thread does between two steps.
void end_step(PanelDressing& dressing) {
  GarmentGrid& grid = dressing.grid;
  const DressingSettings& rules = dressing.garment.dressing;
  ++dressing.steps;
  if (!ends_seaming(rules, dressing.progress, dressing.steps, dressing.dt_s)) return;
  std::fill(grid.sewn.begin(), grid.sewn.end(), std::uint8_t{1});
  dressing.progress = {0, true, dressing.steps};
}

/// A thread, its blocks, what it computes forces in, and where it meets the others.
struct Worker {
  Worker(const PanelDressing& dressing, std::size_t number, std::size_t threads, SpinBarrier& of_all)
      : thread(number),
        range{number * dressing.grid.blocks.size() / threads,
              (number + 1) * dressing.grid.blocks.size() / threads},
        scratch(dressing.grid),
        barrier(of_all) {}

  std::size_t thread;
  BlockRange range;
  ForceScratch scratch;
  SpinBarrier& barrier;
};

/// The threads that the runtime gives to a parallel region: OMP_THREAD_LIMIT may make them fewer than were
/// asked for.
class Team {
 public:
  /// This thread's part. All threads of a region call it first; it makes parts for as many as there are.
  Worker& join(PanelDressing& dressing) {
#pragma omp single
    if (const auto threads = static_cast<std::size_t>(omp_get_num_threads()); threads != workers_.size()) {
      workers_.clear();
      barrier_.emplace(threads, dressing.team_gain);
      for (std::size_t thread = 0; thread < threads; ++thread)
        workers_.emplace_back(dressing, thread, threads, *barrier_);
    }
    return workers_[static_cast<std::size_t>(omp_get_thread_num())];
  }
  /// All parts as one, of a thread that works alone.
  Worker& whole(const PanelDressing& dressing) {
    if (!whole_) whole_.emplace(dressing, 0, 1, no_barrier_);
    return *whole_;
  }

 private:
  SpinBarrier no_barrier_{1};
  std::optional<Worker> whole_;
  std::optional<SpinBarrier> barrier_;
  std::vector<Worker> workers_;
};

StepRule step_rule(const PanelDressing& dressing) {
  const DressingSettings& rules = dressing.garment.dressing;
  const bool draping = dressing.progress.draping;
  return {static_cast<float>(dressing.dt_s), static_cast<float>(rules.push_speed),
          phase_rule<float>(dressing.system, rules, draping), !draping, dressing.layers.has_value()};
}

/// Loops 1 to 4, up to where layers meet each other.
void accelerate(PanelDressing& dressing, Worker& worker) {
  const StepRule rule = step_rule(dressing);
  if (rule.has_joints) {
    if (worker.thread == 0) pull_joints(dressing);
    worker.barrier.wait();
  }
  for (std::size_t b = worker.range.begin; b < worker.range.end; ++b)
    update_velocities(dressing.grid, dressing.grid.blocks[b], rule, worker.scratch);
}

/// What is left of a step.
void move(PanelDressing& dressing, const Worker& worker) {
  GarmentGrid& grid = dressing.grid;
  const DressingSettings& rules = dressing.garment.dressing;
  const BlockRange range = worker.range;
  const StepRule rule = step_rule(dressing);
  if (rule.layers_touch)
    for (std::size_t b = range.begin; b < range.end; ++b) collide_with_body(grid, grid.blocks[b], rule);
  const std::uint32_t sweeps = correction_sweeps(rules);
  if (sweeps == 0) worker.barrier.wait();
  correct(grid, correction_rule<float>(rules, dressing.dt_s), sweeps, range, worker.barrier);
  worker.barrier.wait();
  if (worker.thread == 0) {
    close_sewn_joints(dressing);
    end_step(dressing);
  }
  worker.barrier.wait();
  for (std::size_t b = range.begin; b < range.end; ++b)
    move_block(grid, grid.blocks[b], Lanes(rule.dt), dressing.system.floor);
}

/// Layers of the garment collide.
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

/// A step, until the thread has moved its own nodes.
void take_step(PanelDressing& dressing, Worker& worker) {
  accelerate(dressing, worker);
  if (dressing.layers) {
    worker.barrier.wait();
    if (worker.thread == 0) collide_layers(dressing);
    worker.barrier.wait();
  }
  move(dressing, worker);
}

void step_panels(PanelDressing& dressing, int count) {
  Team team;
  if (!dressing.layers || dressing.layers->threads() == 1) {
    const auto step_alone = [&](std::size_t step) {
      if (step >= static_cast<std::size_t>(count)) return false;
      take_step(dressing, team.whole(dressing));
      return true;
    };
    const std::size_t begin = dressing.team_gain.take_rounds(step_alone);
    if (begin == static_cast<std::size_t>(count)) return;
#pragma omp parallel num_threads(static_cast <int>(dressing.threads))
    {
      Worker& worker = team.join(dressing);
      for (std::size_t step = begin; step < static_cast<std::size_t>(count); ++step) {
        take_step(dressing, worker);
        step += worker.barrier.end_round([&](std::size_t taken) { return step_alone(step + 1 + taken); });
      }
    }
    return;
  }
  // The threads of the collision are a team of their own.
  for (int step = 0; step < count; ++step) {
#pragma omp parallel num_threads(static_cast <int>(dressing.threads))
    accelerate(dressing, team.join(dressing));
    collide_layers(dressing);
#pragma omp parallel num_threads(static_cast <int>(dressing.threads))
    move(dressing, team.join(dressing));
  }
}

PanelKernel panel_kernel() { return {hwy::TargetName(HWY_TARGET), &step_panels}; }

}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mssim {
HWY_EXPORT(panel_kernel);
std::vector<PanelKernel> panel_kernels() {
  return kernels_of_this_processor(HWY_DISPATCH_TABLE(panel_kernel));
}
}  // namespace mssim
#endif
