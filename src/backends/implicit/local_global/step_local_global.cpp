// Steps of fast-springs with vectors: forces of whole vectors of nodes, and products of dense blocks with
// three vectors at once.
#include "backends/vectors/instruction_sets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "backends/implicit/local_global/step_local_global.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>

#include "backends/implicit/local_global/step_local_global.h"
#include "backends/implicit/nodes/node_vectors-inl.h"
#include "backends/threads/spin_barrier.h"

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {

/// Columns of a panel processed at once: as many as AVX2's registers allow.
constexpr std::size_t columns_at_once = 4;

/// front += panel * right, in whole vectors: `columns` columns of `rows` floats; right: [columns][3].
template <std::size_t columns>
HWY_INLINE void add_columns(const float* HWY_RESTRICT panel, std::size_t rows,
                            const float* HWY_RESTRICT right, float* HWY_RESTRICT front) {
  const RealTag d;
  hn::Vec<RealTag> factor[columns][3];
  for (std::size_t j = 0; j < columns; ++j)
    for (std::size_t c = 0; c < 3; ++c) factor[j][c] = hn::Set(d, right[3 * j + c]);
  for (std::size_t i = 0; i < rows; i += lane_count()) {
    auto x = hn::Load(d, front + i), y = hn::Load(d, front + rows + i), z = hn::Load(d, front + 2 * rows + i);
    for (std::size_t j = 0; j < columns; ++j) {
      const auto entry = hn::Load(d, panel + j * rows + i);
      x = hn::MulAdd(entry, factor[j][0], x);
      y = hn::MulAdd(entry, factor[j][1], y);
      z = hn::MulAdd(entry, factor[j][2], z);
    }
    hn::Store(x, d, front + i);
    hn::Store(y, d, front + rows + i);
    hn::Store(z, d, front + 2 * rows + i);
  }
}

/// sums[j][c] = column j of the panel times coordinate c of the solution, over its first `length` floats,
/// whole vectors.
template <std::size_t columns>
HWY_INLINE void multiply_columns(const float* HWY_RESTRICT panel, std::size_t rows,
                                 const float* HWY_RESTRICT solution, std::size_t length,
                                 float* HWY_RESTRICT sums) {
  const RealTag d;
  hn::Vec<RealTag> sum[columns][3];
  for (std::size_t j = 0; j < columns; ++j)
    for (std::size_t c = 0; c < 3; ++c) sum[j][c] = hn::Zero(d);
  for (std::size_t i = 0; i < length; i += lane_count()) {
    const auto x = hn::Load(d, solution + i), y = hn::Load(d, solution + rows + i),
               z = hn::Load(d, solution + 2 * rows + i);
    for (std::size_t j = 0; j < columns; ++j) {
      const auto entry = hn::Load(d, panel + j * rows + i);
      sum[j][0] = hn::MulAdd(entry, x, sum[j][0]);
      sum[j][1] = hn::MulAdd(entry, y, sum[j][1]);
      sum[j][2] = hn::MulAdd(entry, z, sum[j][2]);
    }
  }
  for (std::size_t j = 0; j < columns; ++j)
    for (std::size_t c = 0; c < 3; ++c) sums[3 * j + c] = hn::GetLane(hn::SumOfLanes(d, sum[j][c]));
}

/// Calls act(column, integral constant of the number of columns from it on) for all columns.
template <class Act>
HWY_INLINE void for_each_columns(std::size_t columns, Act&& act) {
  std::size_t j = 0;
  for (; j + columns_at_once <= columns; j += columns_at_once)
    act(j, std::integral_constant<std::size_t, columns_at_once>{});
  for (; j < columns; ++j) act(j, std::integral_constant<std::size_t, 1>{});
}

/// A part on the way up: gathers the right-hand side of the part's nodes and its children's contributions,
/// and leaves its own contribution for the parent. scratch: floats for three coordinates of all pivots.
template <class Nodes>
HWY_NOINLINE void pass_upwards(LocalGlobalNodes<Nodes>& system, std::size_t part, float* scratch) {
  const Fronts& fronts = system.factor.fronts;
  const BlockFactor::Block& block = system.factor.blocks[part];
  const std::size_t rows = block.rows, border = fronts.border_size(part), pivots = fronts.pivots(part);
  const std::size_t step = system.nodes.component_step();
  float* const front = system.fronts.data() + block.front;
  std::fill_n(front, 3 * rows, 0.0F);
  for (std::size_t i = 0; i < pivots; ++i) {
    const auto& place = system.places[fronts.parts[part].begin + i];
    for (std::size_t c = 0; c < 3; ++c)
      front[c * rows + border + i] = place.mass * system.e.data()[place.offset + c * step];
  }
  for (const std::uint32_t child : fronts.children.of(part)) {
    const std::uint32_t* const at = fronts.at_parent.data() + fronts.first_border[child];
    const std::size_t size = fronts.border_size(child), child_rows = system.factor.blocks[child].rows;
    const float* const left = system.fronts.data() + system.factor.blocks[child].front;
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t i = 0; i < size; ++i) front[c * rows + at[i]] += left[c * child_rows + i];
  }
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < pivots; ++i) {
      float& value = front[c * rows + border + i];
      scratch[3 * i + c] = value;
      value = 0;
    }
  const float* const panel = system.factor.panels.data() + block.panel;
  for_each_columns(pivots, [&](std::size_t j, auto columns) HWY_ATTR {
    add_columns<columns()>(panel + j * rows, rows, scratch + 3 * j, front);
  });
}

/// A part on the way down: takes the solution at its border from its parent, computes its own, and moves its
/// nodes. scratch: floats for three coordinates of all rows.
template <class Nodes>
HWY_NOINLINE void pass_downwards(LocalGlobalNodes<Nodes>& system, std::size_t part, float* scratch) {
  const Fronts& fronts = system.factor.fronts;
  const BlockFactor::Block& block = system.factor.blocks[part];
  const std::size_t rows = block.rows, border = fronts.border_size(part), pivots = fronts.pivots(part);
  const std::size_t step = system.nodes.component_step(), lanes = lane_count();
  const std::size_t length = round_up(border, lanes);
  float* const front = system.fronts.data() + block.front;
  if (border > 0) {
    const std::uint32_t* const at = fronts.at_parent.data() + fronts.first_border[part];
    const BlockFactor::Block& above = system.factor.blocks[fronts.parts[part].parent];
    const float* const solved = system.fronts.data() + above.front;
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t i = 0; i < border; ++i)
        scratch[c * rows + i] = front[c * rows + i] = solved[c * above.rows + at[i]];
      std::fill(scratch + c * rows + border, scratch + c * rows + length, 0.0F);
    }
    const float* const panel = system.factor.panels.data() + block.panel;
    for_each_columns(pivots, [&](std::size_t j, auto columns) HWY_ATTR {
      float sums[columns_at_once * 3];
      multiply_columns<columns()>(panel + j * rows, rows, scratch, length, sums);
      for (std::size_t k = 0; k < columns(); ++k)
        for (std::size_t c = 0; c < 3; ++c) front[c * rows + border + j + k] += sums[3 * k + c];
    });
  }
  for (std::size_t i = 0; i < pivots; ++i) {
    const std::size_t offset = system.places[fronts.parts[part].begin + i].offset;
    for (std::size_t c = 0; c < 3; ++c) {
      float& w = system.w.data()[offset + c * step];
      w += front[c * rows + border + i];
      system.y.data()[offset + c * step] = system.x.data()[offset + c * step] + system.dt * w;
    }
  }
}

/// Initialises the iteration from the state.
template <class Nodes>
HWY_NOINLINE void begin_step(LocalGlobalNodes<Nodes>& system, IndexRange chunk) {
  for_each_vector(system.nodes, chunk, [&](const auto& vector) HWY_ATTR {
    const Lanes3 v = vector.load(system.v.data());
    vector.store(system.w.data(), v);
    vector.store(system.y.data(), mul_add(Lanes(system.dt), v, vector.load(system.x.data())));
  });
}

/// The local step: accelerations by springs, air and gravity at positions y and velocities w.
template <class Nodes>
HWY_NOINLINE void find_missing(LocalGlobalNodes<Nodes>& system, IndexRange chunk) {
  const Surroundings& around = system.nodes.surroundings;
  const float *const y = system.y.data(), *const w = system.w.data(), *const v = system.v.data();
  for_each_vector(system.nodes, chunk, [&](const auto& vector) HWY_ATTR {
    const NodeLanes node{vector.load(y), vector.load(w)};
    Lanes3 pull = zero3();
    vector.for_each_spring([&](const auto& springs) MSSIM_INLINE_LAMBDA {
      const Lanes3 to_other = springs.load(y) - node.x;
      const Lanes factor = spring_pull_at(inverse_length(dot(to_other, to_other)),
                                          dot(springs.load(w) - node.v, to_other), springs.law);
      pull = mul_add(keep(springs.exists, factor), to_other, pull);
    });
    const Lanes3 a = node_acceleration(pull, node.v, Lanes(around.viscous_damping), Lanes(around.gravity));
    const Lanes3 change = node.v - vector.load(v);
    vector.store(system.e.data(), keep(vector.free, Lanes(system.dt) * a - change));
  });
}

/// The result of the iterations becomes the state, and the floor acts on it.
template <class Nodes>
HWY_NOINLINE void end_step(LocalGlobalNodes<Nodes>& system, IndexRange chunk) {
  for_each_vector(system.nodes, chunk, [&](const auto& vector) HWY_ATTR {
    Lanes3 x = vector.load(system.y.data()), v = vector.load(system.w.data());
    touch_floor(vector.free, system.nodes.surroundings, x, v);
    vector.store(system.x.data(), x);
    vector.store(system.v.data(), v);
  });
}

template <class Nodes>
void take_steps(LocalGlobalNodes<Nodes>& system, int count) {
  with_team(system.threads, [&](const Team& team) HWY_ATTR {
    AlignedArray scratch(3 * system.factor.most_rows);
    const auto for_chunks = [&](auto act) HWY_ATTR {
      const std::size_t chunks = system.nodes.chunks.size();
      for (std::size_t i = team.begin(chunks); i < team.end(chunks); ++i) act(system, system.nodes.chunks[i]);
      team.meet();
    };
    // The fronts are distributed among system.threads shares: fewer threads take several shares each.
    const auto& phases = system.schedule.phases;
    for (int step = 0; step < count; ++step) {
      for_chunks(begin_step<Nodes>);
      for (std::uint32_t iteration = 0; iteration < system.iterations; ++iteration) {
        for_chunks(find_missing<Nodes>);
        for (const auto& phase : phases) {
          for (std::size_t share = team.thread; share < system.threads; share += team.threads)
            for (const IndexRange& item : phase[share])
              for (std::size_t part = item.begin; part < item.end; ++part)
                pass_upwards(system, part, scratch.data());
          team.meet();
        }
        for (auto phase = phases.rbegin(); phase != phases.rend(); ++phase) {
          for (std::size_t share = team.thread; share < system.threads; share += team.threads)
            for (auto item = (*phase)[share].rbegin(); item != (*phase)[share].rend(); ++item)
              for (std::size_t part = item->end; part-- > item->begin;)
                pass_downwards(system, part, scratch.data());
          team.meet();
        }
      }
      for_chunks(end_step<Nodes>);
    }
  });
}

StepKernel<LocalGlobalNodes<NodeRows>> local_global_cloth_kernel() {
  return kernel_here(&take_steps<NodeRows>);
}
StepKernel<LocalGlobalNodes<NodeSlices>> local_global_bodies_kernel() {
  return kernel_here(&take_steps<NodeSlices>);
}

}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mssim {
MSSIM_COMPILED_KERNELS(LocalGlobalNodes<NodeRows>, local_global_cloth_kernel)
MSSIM_COMPILED_KERNELS(LocalGlobalNodes<NodeSlices>, local_global_bodies_kernel)
}  // namespace mssim
#endif
