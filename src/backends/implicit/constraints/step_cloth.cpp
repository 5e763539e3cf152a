// Small steps of a cloth, pass by pass. Compiled once per instruction set: hwy/foreach_target.h includes this
// file again for each.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "backends/implicit/constraints/step_cloth.cpp"
#include "backends/implicit/constraints/step_cloth.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#include <omp.h>

#include <algorithm>
#include <optional>

#include "backends/implicit/constraints/cloth_rows-inl.h"
#include "backends/implicit/constraints/row_blocks.h"
#include "backends/threads/spin_barrier.h"

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {

/// One level of a block of rows. `meets_floor`: the small step is the last of a step.
HWY_INLINE void do_level(QuarteredRows& cloth, BlockLevel level, std::size_t block, bool meets_floor) {
  const std::size_t rows = cloth.layout.rows, first = block * block_rows;
  const std::size_t end = std::min(first + block_rows, rows);
  const auto pairs_from = [&](std::size_t row, std::size_t most) {
    return row + 1 < rows ? std::min(most, (rows - row) / 2) : 0;
  };
  switch (level) {
    case BlockLevel::own:
      let_fall(cloth, first, end - first);
      project_along_rows(cloth, first, end - first);
      project_between_rows(cloth, first, pairs_from(first, 2));
      return;
    case BlockLevel::join:
      if (block > 0)
        project_between_rows(cloth, first - 1, pairs_from(first - 1, 2));
      else
        project_between_rows(cloth, 1, pairs_from(1, 1));
      return;
    case BlockLevel::bend:
      project_across_rows(cloth, first, std::min<std::size_t>(2, rows - std::min(rows, first + 2)));
      return;
    case BlockLevel::bend_join:
      if (block == 0) return;
      project_across_rows(cloth, first - 2, std::min<std::size_t>(2, rows - first));
      return;
    case BlockLevel::advance:
      advance(cloth, first, end - first, meets_floor);
      return;
  }
}

/// Goes down the cloth with all levels of the small steps `begin` to `end` - 1 of a call, each in
/// range(number of the small step in the pass, level).
template <class Range>
HWY_NOINLINE void walk_down(QuarteredRows& cloth, std::size_t begin, std::size_t end, Range range) {
  std::size_t first = block_count(cloth.layout.rows), last = 0;
  const auto for_each_level = [&](auto&& act) MSSIM_INLINE_LAMBDA {
    for (std::size_t small = 0; small < end - begin; ++small)
      for (std::size_t level = 0; level < block_levels; ++level) act(small, static_cast<BlockLevel>(level));
  };
  for_each_level([&](std::size_t small, BlockLevel level) HWY_ATTR {
    const BlockRange blocks = range(small, level);
    first = std::min(first, blocks.begin + lag(small, level));
    last = std::max(last, blocks.end + lag(small, level));
  });
  for (std::size_t front = first; front < last; ++front)
    for_each_level([&](std::size_t small, BlockLevel level) HWY_ATTR {
      const BlockRange blocks = range(small, level);
      const std::size_t block = front - lag(small, level);
      if (front < blocks.begin + lag(small, level) || block >= blocks.end) return;
      do_level(cloth, level, block, (begin + small + 1) % cloth.substeps == 0);
    });
}

/// Takes `count` steps.
void step_cloth(QuarteredRows& cloth, int count) {
  // Whatever the threads are, each spring sees what the colours before its own have left: the result is the
  // same to the last bit for any number of threads and of small steps in a pass.
  const std::size_t small_steps = static_cast<std::size_t>(count) * cloth.substeps;
  const std::size_t passes = (small_steps + cloth.depth - 1) / cloth.depth;
  const std::size_t blocks = block_count(cloth.layout.rows);
  const auto walk = [&](std::size_t pass, auto&& range) HWY_ATTR {
    walk_down(cloth, pass * cloth.depth, std::min((pass + 1) * cloth.depth, small_steps), range);
  };
  const auto pass_alone = [&](std::size_t pass) HWY_ATTR {
    if (pass >= passes) return false;
    walk(pass, [&](std::size_t, BlockLevel) HWY_ATTR { return BlockRange{0, blocks}; });
    return true;
  };
  const std::size_t begin = cloth.team_gain.take_rounds(pass_alone);
  if (begin == passes) return;
  std::optional<SpinBarrier> barrier;
#pragma omp parallel num_threads(static_cast <int>(cloth.threads))
  {
    const auto thread = static_cast<std::size_t>(omp_get_thread_num());
    const auto threads = static_cast<std::size_t>(omp_get_num_threads());  // the runtime may give fewer
#pragma omp single
    barrier.emplace(threads, cloth.team_gain);
    const BlockShare own(thread, threads, blocks);
    for (std::size_t pass = begin; pass < passes; ++pass) {
      walk(pass, [&](std::size_t small, BlockLevel level) HWY_ATTR { return own.alone(small, level); });
      if (threads == 1) continue;
      barrier->wait();
      if (thread + 1 < threads) {
        const BlockShare next(thread + 1, threads, blocks);
        walk(pass, [&](std::size_t small, BlockLevel level) HWY_ATTR {
          return BlockRange{own.alone(small, level).end, next.alone(small, level).begin};
        });
      }
      pass += barrier->end_round([&](std::size_t taken) HWY_ATTR { return pass_alone(pass + 1 + taken); });
    }
  }
}

ClothConstraintKernel cloth_constraint_kernel() {
  return {lane_count(), hwy::TargetName(HWY_TARGET), exact_roots, &step_cloth};
}

}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mssim {
HWY_EXPORT(cloth_constraint_kernel);
std::vector<ClothConstraintKernel> cloth_constraint_kernels() {
  return kernels_of_this_processor(HWY_DISPATCH_TABLE(cloth_constraint_kernel));
}
}  // namespace mssim
#endif
