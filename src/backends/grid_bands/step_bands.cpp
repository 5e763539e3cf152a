// Compiled once per instruction set: hwy/foreach_target.h includes this file again for each.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "backends/grid_bands/step_bands.cpp"
#include "backends/grid_bands/step_bands.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#include <omp.h>

#include <algorithm>
#include <cstring>
#include <optional>

#include "backends/grid_bands/column_walk-inl.h"
#include "backends/spin_barrier.h"

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {

/// Puts the pins of a freshly written column back and renews its halo rows, pair by pair that a later stage
/// gathers. Row -1 of a lane is the last row of the lane before it, so a halo row is an unaligned load one
/// float away. The first or last lane gets a stray number from the neighbouring component, which every spring
/// there masks.
template <std::size_t method, std::size_t stage>
HWY_INLINE void finish_column(const BandSheet& sheet, const BandPart& part, std::size_t column) {
  constexpr Stage table = integrators[method].stages[stage];
  const auto refresh = [&]<std::size_t i>(std::integral_constant<std::size_t, i>) MSSIM_INLINE_LAMBDA {
    constexpr Pair pair = static_cast<Pair>(i);
    if constexpr (writes(table, position_slot(pair)) && is_gathered(integrators[method], pair)) {
      const std::size_t lanes = lane_count(), row_floats = sheet.layout.row_floats();
      float* start = part.column(sheet.layout, pair, static_cast<std::ptrdiff_t>(column));
      for (const BandPin& pin : part.pins[column])
        for (std::size_t k = 0; k < 3; ++k) {
          start[pin.offset + k * lanes] = pin.position[k];
          start[pin.offset + (3 + k) * lanes] = 0;
        }
      float* above = start;
      const float* last = start + sheet.layout.height * row_floats;
      float* under = start + (sheet.layout.height + BandLayout::halo) * row_floats;
      const float* first = start + BandLayout::halo * row_floats;
      for (std::size_t i_float = 0; i_float < BandLayout::halo * row_floats; i_float += lanes) {
        hn::Store(hn::LoadU(FloatTag(), last + i_float - 1), FloatTag(), above + i_float);
        hn::Store(hn::LoadU(FloatTag(), first + i_float + 1), FloatTag(), under + i_float);
      }
    }
  };
  [&]<std::size_t... i>(std::index_sequence<i...>) MSSIM_INLINE_LAMBDA {
    (refresh(std::integral_constant<std::size_t, i>{}), ...);
  }
  (std::make_index_sequence<pair_kinds>{});
}

/// One stage over the columns of a part, ghosts on the left first for what their springs do to the part's
/// columns.
template <std::size_t method, std::size_t stage>
HWY_INLINE void walk_part(const BandSheet& sheet, BandPart& part) {
  constexpr Pair gather = integrators[method].stages[stage].gather;
  const BandLayout& layout = sheet.layout;
  const auto count = static_cast<std::ptrdiff_t>(part.count), first = static_cast<std::ptrdiff_t>(part.first);
  const auto columns = static_cast<std::ptrdiff_t>(layout.columns);
  const std::ptrdiff_t to_row_0 = static_cast<std::ptrdiff_t>(BandLayout::halo * layout.row_floats());

  std::array<float*, 3> forces;
  for (std::size_t i = 0; i < forces.size(); ++i)
    forces[i] = part.forces.data() + (stage * forces.size() + i) * layout.force_floats();
  for (std::size_t i = 0; i < 2; ++i) std::memset(forces[i], 0, layout.force_floats() * sizeof(float));

  for (std::ptrdiff_t c = part.first > 0 ? -2 : 0; c < count; ++c) {
    ColumnView view;
    view.here = part.column(layout, gather, c) + to_row_0;
    view.next = part.column(layout, gather, c + 1) + to_row_0;
    view.next_2 = part.column(layout, gather, c + 2) + to_row_0;
    for (std::size_t i = 0; i < pair_kinds; ++i)
      view.pairs[i] =
          part.base[i] == nullptr ? nullptr : part.column(layout, static_cast<Pair>(i), c) + to_row_0;
    view.forces_here = forces[0];
    view.forces_next = forces[1];
    view.forces_next_2 = forces[2];
    if (c == -2) {
      walk_column<method, stage, right_2, false>(sheet, view);
    } else if (c == -1) {
      walk_column<method, stage, to_next_column | right_2, false>(sheet, view);
    } else {
      if (first + c < columns - 2) {
        walk_column<method, stage, every_spring, true>(sheet, view);
      } else if (first + c < columns - 1) {
        walk_column<method, stage, within_column | to_next_column, true>(sheet, view);
      } else {
        walk_column<method, stage, within_column, true>(sheet, view);
      }
      finish_column<method, stage>(sheet, part, static_cast<std::size_t>(c));
    }
    std::rotate(forces.begin(), forces.begin() + 1, forces.end());
  }
}

/// Copies the ghost columns of `pair` from the parts that own them.
HWY_INLINE void fetch_ghosts(const BandSheet& sheet, std::size_t p, Pair pair) {
  const BandPart& part = sheet.parts[p];
  constexpr auto ghosts = static_cast<std::ptrdiff_t>(BandLayout::halo);
  const std::size_t bytes = BandLayout::halo * sheet.layout.column_floats() * sizeof(float);
  if (p > 0) {
    const BandPart& left = sheet.parts[p - 1];
    std::memcpy(part.column(sheet.layout, pair, -ghosts),
                left.column(sheet.layout, pair, static_cast<std::ptrdiff_t>(left.count) - ghosts), bytes);
  }
  if (p + 1 < sheet.parts.size())
    std::memcpy(part.column(sheet.layout, pair, static_cast<std::ptrdiff_t>(part.count)),
                sheet.parts[p + 1].column(sheet.layout, pair, 0), bytes);
}

template <std::size_t method>
HWY_INLINE void step_method(BandSheet& sheet, int count) {
  // Every thread computes its own columns whole, whatever their number: the order of every sum depends on the
  // cloth alone, and the result is the same to the last bit for any number of threads.
  const int parts = static_cast<int>(sheet.parts.size());
  std::optional<SpinBarrier> barrier;
#pragma omp parallel num_threads(parts)
  {
    const auto thread = static_cast<std::size_t>(omp_get_thread_num());
    const auto threads = static_cast<std::size_t>(omp_get_num_threads());  // the runtime may give fewer
#pragma omp single
    barrier.emplace(threads);
    const auto for_my_parts = [&](auto&& act) HWY_ATTR {
      for (std::size_t p = thread; p < sheet.parts.size(); p += threads) act(p);
    };
    for (int step = 0; step < count; ++step)
      for_each_stage<method>([&](auto stage) HWY_ATTR {
        constexpr std::size_t s = stage, stages = integrators[method].stage_count;
        constexpr bool last = s + 1 == stages;
        constexpr Pair gathered_next =
            last ? Pair::next : integrators[method].stages[(s + 1) % stages].gather;
        for_my_parts([&](std::size_t p) HWY_ATTR { walk_part<method, s>(sheet, sheet.parts[p]); });
        if (sheet.parts.size() > 1) {
          barrier->wait();
          for_my_parts([&](std::size_t p) HWY_ATTR { fetch_ghosts(sheet, p, gathered_next); });
          barrier->wait();
        }
        if constexpr (last && swaps_state(integrators[method], Storage::in_place))
          for_my_parts([&](std::size_t p) HWY_ATTR {
            std::swap(sheet.parts[p].base[index(Pair::state)], sheet.parts[p].base[index(Pair::next)]);
          });
      });
  }
}

void step_bands(BandSheet& sheet, int count) {
  with_integrator(*sheet.integrator, [&](auto method) HWY_ATTR { step_method<method>(sheet, count); });
}

BandKernel band_kernel() { return {lane_count(), hwy::TargetName(HWY_TARGET), &step_bands}; }

}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mssim {
HWY_EXPORT(band_kernel);
std::vector<BandKernel> band_kernels() { return kernels_of_this_processor(HWY_DISPATCH_TABLE(band_kernel)); }
}  // namespace mssim
#endif
