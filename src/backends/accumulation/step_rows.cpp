// The walk over a cloth in padded rows: every node gathers. Compiled for the integrators of MSSIM_STAGES.
#include "backends/vectors/instruction_sets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "backends/accumulation/step_rows.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <utility>

#include "backends/accumulation/gather_vectors.h"
#include "backends/layouts/node_lanes-inl.h"
#include "backends/threads/spin_barrier.h"

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {

/// WalkedRows with the surroundings and coefficients of explicit steps.
struct ClothConstants : WalkedRows {
  Coefficients<float> coefficients;
  Surroundings surroundings;
  std::uint32_t rows, columns;
  HWY_INLINE explicit ClothConstants(const PaddedRows& cloth)
      : WalkedRows(cloth.springs, cloth.layout.pitch),
        coefficients(cloth.coefficients),
        surroundings(cloth.surroundings),
        rows(static_cast<std::uint32_t>(cloth.layout.rows)),
        columns(static_cast<std::uint32_t>(cloth.layout.columns)) {}
};

/// Acceleration of a vector of nodes by their springs. `here`: their x in the gathered pair.
template <class Place>
HWY_INLINE Lanes3 spring_acceleration(const ClothConstants& constants, const Place& place, const float* here,
                                      const NodeLanes& node) {
  const std::ptrdiff_t pitch = constants.pitch;
  Lanes3 sum = zero3();
  const auto add = [&]<std::size_t i>(std::integral_constant<std::size_t, i>) MSSIM_INLINE_LAMBDA {
    constexpr GridSpring to = spring_of_node(i);
    const SpringLanes& spring = constants.spring[to.kind];
    const NodeLanes other = load_node(
        here + to.rows * static_cast<std::ptrdiff_t>(PairRows::components) * pitch + to.columns, pitch);
    const Lanes3 to_other = other.x - node.x;
    const Lanes pull =
        spring_pull_at(inverse_length(dot(to_other, to_other)), dot(other.v - node.v, to_other), spring);
    sum = mul_add(keep(place.has(to.rows, to.columns), pull), to_other, sum);
  };
  [&]<std::size_t... i>(std::index_sequence<i...>) MSSIM_INLINE_LAMBDA {
    (add(std::integral_constant<std::size_t, i>{}), ...);
  }
  (std::make_index_sequence<node_springs>{});
  return sum;
}

/// The acceleration at edges, not inlined: a copy in every stage would take long to compile.
HWY_NOINLINE inline Lanes3 edge_acceleration(const ClothConstants& constants, const EdgeVector& place,
                                             const float* here, const NodeLanes& node) {
  return spring_acceleration(constants, place, here, node);
}

/// Start of each pair's arrays, by role.
using Arrays = std::array<float*, pair_kinds>;

/// One stage at a vector of nodes whose x is `offset` floats after each array's start.
template <std::size_t method, std::size_t stage, class Place>
HWY_INLINE void step_vector(const ClothConstants& constants, const Place& place, const Arrays& arrays,
                            std::size_t offset) {
  const std::ptrdiff_t pitch = constants.pitch;
  const float* here = arrays[index(integrators[method].stages[stage].gather)] + offset;
  const NodeLanes node = load_node(here, pitch);
  const Lanes3 pull = [&]() MSSIM_INLINE_LAMBDA {
    if constexpr (std::is_same_v<Place, EdgeVector>)
      return edge_acceleration(constants, place, here, node);
    else
      return spring_acceleration(constants, place, here, node);
  }();
  const auto address = [&](std::size_t slot) MSSIM_INLINE_LAMBDA {
    return arrays[slot / 2] + offset + (slot % 2 == 0 ? 0 : 3 * pitch);
  };
  update_lanes<method, stage>(
      node, pull, place.has(0, 0), Lanes(constants.surroundings.gravity), constants.coefficients,
      constants.surroundings,
      [&](auto slot)
          MSSIM_INLINE_LAMBDA { return load_components(address(index(decltype(slot)::value)), pitch); },
      [&](auto slot, const Lanes3& value)
          MSSIM_INLINE_LAMBDA { store3(address(index(decltype(slot)::value)), value, pitch); });
}

/// The vectors of columns [begin, end) of a row in which some springs or lanes are missing.
template <std::size_t method, std::size_t stage>
HWY_NOINLINE void step_edge(const ClothConstants& constants, const Arrays& arrays, const PairRows& layout,
                            std::size_t row, std::size_t begin, std::size_t end) {
  for (std::size_t column = begin; column < end; column += lane_count())
    step_vector<method, stage>(
        constants,
        EdgeVector{static_cast<std::uint32_t>(row), hn::Iota(IndexTag(), static_cast<std::uint32_t>(column)),
                   constants.rows, constants.columns},
        arrays, layout.offset(row, column));
}

/// Prefetches the row that the next row's nodes are the first to gather. On two Zen 4 cores at 500 x 700,
/// whose state is in the last-level cache: 1.1 to 1.2 times as fast.
HWY_INLINE void prefetch_row_below(const float* here, std::ptrdiff_t pitch) {
  constexpr std::ptrdiff_t components = PairRows::components, rows = PairRows::ring + 1;
  for (std::ptrdiff_t component = 0; component < components; ++component)
    hwy::Prefetch(here + (rows * components + component) * pitch);  // every address is valid
}

/// The vectors from `begin` to `end` floats after each array's start, with all their springs.
template <std::size_t method, std::size_t stage>
HWY_NOINLINE void step_inside(const ClothConstants& all, const Arrays& starts, std::size_t begin,
                              std::size_t end) {
  const ClothConstants constants = all;
  const Arrays arrays = starts;
  const float* const gathered = arrays[index(integrators[method].stages[stage].gather)];
  for (std::size_t offset = begin; offset < end; offset += lane_count()) {
    prefetch_row_below(gathered + offset, constants.pitch);
    step_vector<method, stage>(constants, InnerVector{}, arrays, offset);
  }
}

/// Resets the pins of a newly written row of an array.
HWY_INLINE void put_back_pins(const PaddedRows& cloth, std::size_t row, float* array) {
  const std::size_t pitch = cloth.layout.pitch;
  for (std::size_t i = cloth.first_pin[row]; i < cloth.first_pin[row + 1]; ++i) {
    const PlacedPin<float>& pin = cloth.pins[i];
    for (std::size_t k = 0; k < 3; ++k) {
      array[pin.offset + k * pitch] = pin.position[k];
      array[pin.offset + (3 + k) * pitch] = 0;
    }
  }
}

/// One stage at the nodes of one row.
template <std::size_t method, std::size_t stage>
HWY_INLINE void step_row(const PaddedRows& cloth, const ClothConstants& constants, const Arrays& arrays,
                         std::size_t row) {
  const PairRows& layout = cloth.layout;
  const auto [begin, end] = layout.inner_columns(row, lane_count());
  step_edge<method, stage>(constants, arrays, layout, row, 0, begin);
  step_inside<method, stage>(constants, arrays, layout.offset(row, begin), layout.offset(row, end));
  step_edge<method, stage>(constants, arrays, layout, row, end, layout.columns);
  for (std::size_t pair = 0; pair < pair_kinds; ++pair)
    if (writes(integrators[method].stages[stage], static_cast<Pair>(pair)))
      put_back_pins(cloth, row, arrays[pair]);
}

/// The work of one thread in `count` steps.
template <std::size_t method>
HWY_INLINE void take_steps(const PaddedRows& cloth, const Team& team, int count) {
  const ClothConstants constants(cloth);
  const std::size_t begin = team.begin(cloth.layout.rows), end = team.end(cloth.layout.rows);
  Arrays arrays = cloth.base;
  for (int step = 0; step < count; ++step) {
    for_each_stage<method>([&](auto stage) HWY_ATTR {
      for (std::size_t row = begin; row < end; ++row) step_row<method, stage>(cloth, constants, arrays, row);
      team.meet();  // a stage reads what other threads have written, and writes nothing that it reads
    });
    std::swap(arrays[index(Pair::state)], arrays[index(Pair::next)]);
  }
}

/// Takes `count` steps of an integrator of these Stages.
template <std::size_t stages>
void step_rows(PaddedRows& cloth, int count) {
  // A node sums its springs in the stencil's order, in any lane and thread: the result is bitwise identical
  // for any number of threads.
  with_integrator(*cloth.integrator, [&](auto method) HWY_ATTR {
    if constexpr (Stages<stages>::have(integrators[method]))
      with_team(cloth.threads, [&](const Team& team) HWY_ATTR { take_steps<method>(cloth, team, count); });
  });
  if (count % 2 != 0) std::swap(cloth.base[index(Pair::state)], cloth.base[index(Pair::next)]);
}

namespace {
StepKernel<PaddedRows> row_kernel() { return kernel_here(&step_rows<MSSIM_STAGES>); }
}  // namespace

}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mssim {
MSSIM_COMPILED_KERNELS(PaddedRows, row_kernel)
}  // namespace mssim
#endif
