// Compiled once per instruction set: hwy/foreach_target.h includes this file again for each.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "backends/dressing/step_panels.cpp"
#include "backends/dressing/step_panels.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#include <omp.h>

#include <algorithm>
#include <cmath>

#include "backends/dressing/panel_correction-inl.h"
#include "backends/dressing/panel_forces-inl.h"
#include "backends/dressing/panel_joints.h"
#include "backends/spin_barrier.h"

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {

/// Blocks of one thread.
struct Share {
  std::size_t begin, end;
};

/// Loop 6 for a block.
HWY_INLINE void move_block(PanelSheet& sheet, const PanelSheet::Block& block, Lanes dt, const Floor& floor) {
  const PanelSheet::Panel& panel = sheet.panels[block.panel];
  const std::size_t first = panel.first + block.begin * panel.stride;
  const std::size_t last = panel.first + block.end * panel.stride;
  const Lanes height(static_cast<float>(floor.height));
  for (std::size_t at = first; at < last; at += lane_count()) {
    Lanes3 v = load(sheet.velocity, at), x = mul_add(dt, v, load(sheet.moved, at));
    const Mask real = hn::Gt(hn::Load(FloatTag(), sheet.inverse_mass.data() + at), hn::Zero(FloatTag()));
    const Mask under = hn::And(real, hn::Lt(x.y.v, height.v));
    touch_floor(under, height, Lanes(static_cast<float>(floor.restitution)),
                Lanes(static_cast<float>(floor.friction)), x, v);
    store(sheet.position, at, x);
    store(sheet.velocity, at, v);
  }
}

/// Limits what over-elongated springs do, in the order of correction_order.h: a thread's own blocks, and the
/// springs between each of them and the block before it, which is done when all have passed the barrier.
HWY_INLINE void correct(PanelSheet& sheet, const CorrectionRule<float>& rule, std::uint32_t sweeps,
                        Share share, SpinBarrier& barrier) {
  for (std::uint32_t sweep = 0; sweep < sweeps; ++sweep) {
    const bool forwards = sweep % 2 == 0;
    if (forwards) {
      for (std::size_t b = share.begin; b < share.end; ++b) correct_block(sheet, sheet.blocks[b], rule, true);
      barrier.wait();
    }
    for (std::size_t b = share.begin; b < share.end; ++b)
      if (sheet.blocks[b].begin != 0) correct_seam_of_blocks(sheet, sheet.blocks[b], rule, forwards);
    if (!forwards) {
      barrier.wait();
      for (std::size_t b = share.begin; b < share.end; ++b)
        correct_block(sheet, sheet.blocks[b], rule, false);
    }
  }
}

/// What the first thread does between two steps.
void end_step(PanelDressing& dressing) {
  PanelSheet& sheet = dressing.sheet;
  const Dressing& rules = dressing.garment.dressing;
  ++dressing.steps;
  if (!ends_seaming(rules, dressing.progress, dressing.steps, dressing.dt_s)) return;
  std::fill(sheet.sewn.begin(), sheet.sewn.end(), std::uint8_t{1});
  dressing.progress = {0, true, dressing.steps};
}

void take_steps(PanelDressing& dressing, int count, std::size_t thread, SpinBarrier& barrier) {
  PanelSheet& sheet = dressing.sheet;
  const Dressing& rules = dressing.garment.dressing;
  const auto dt = static_cast<float>(dressing.dt_s);
  const std::size_t blocks = sheet.blocks.size();
  const Share share{thread * blocks / dressing.threads, (thread + 1) * blocks / dressing.threads};
  const auto correction = correction_rule<float>(rules, dressing.dt_s);
  const std::uint32_t sweeps = correction_sweeps(rules);
  ForceScratch scratch(sheet);
  for (int step = 0; step < count; ++step) {
    const bool draping = dressing.progress.draping;
    if (!draping) {
      if (thread == 0) pull_joints(dressing);
      barrier.wait();
    }
    const StepRule rule{dt, static_cast<float>(rules.push_speed),
                        phase_rule<float>(dressing.system, rules, draping), !draping};
    for (std::size_t b = share.begin; b < share.end; ++b)
      update_velocities(sheet, sheet.blocks[b], rule, scratch);
    if (sweeps == 0) barrier.wait();
    correct(sheet, correction, sweeps, share, barrier);
    barrier.wait();
    if (thread == 0) {
      close_sewn_joints(dressing);
      end_step(dressing);
    }
    barrier.wait();
    for (std::size_t b = share.begin; b < share.end; ++b)
      move_block(sheet, sheet.blocks[b], dt, dressing.system.floor);
    barrier.wait();
  }
}

void step_panels(PanelDressing& dressing, int count) {
  SpinBarrier barrier(dressing.threads);
#pragma omp parallel num_threads(static_cast <int>(dressing.threads))
  take_steps(dressing, count, static_cast<std::size_t>(omp_get_thread_num()), barrier);
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
