// What threads that walk beside each other give each other: the columns at the edges of their partitions.
// Compiled once per instruction set, so the guard toggles.
#if defined(MSSIM_EDGE_COLUMNS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MSSIM_EDGE_COLUMNS_INL_H_
#undef MSSIM_EDGE_COLUMNS_INL_H_
#else
#define MSSIM_EDGE_COLUMNS_INL_H_
#endif

#include <hwy/cache_control.h>

#include <cstring>

#include "backends/layouts/band_grid.h"
#include "backends/vectors/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {

/// Copies the ghost columns of a pass at one side of a partition from the partition beside it, as soon as
/// they are there. Adds to `waited` how long that took if it was long.
HWY_NOINLINE inline void take_ghosts(const BandLayout& layout, BandPartition& partition, EdgeColumns& edge,
                                     std::size_t first, std::uint64_t pass, TeamGain::Duration& waited) {
  edge.pass.wait_for(pass, waited);
  for (std::size_t i = 0; i < partition.ghosts; ++i)
    std::memcpy(partition.column(layout, Pair::state, first + i) + BandLayout::halo * layout.row_floats(),
                edge.column(layout, pass, i), EdgeColumns::column_floats(layout) * sizeof(float));
}

/// Asks for the memory that a column of an edge is going to be written to. It is in the cache of the thread
/// that read it, and stores that must wait for it hold up all that follow.
HWY_INLINE void prefetch_to_leave(const BandLayout& layout, EdgeColumns& edge, std::size_t number,
                                  std::uint64_t pass) {
  constexpr std::size_t line_floats = 16;
  const float* column = edge.column(layout, pass + 1, number);
  for (std::size_t i = 0; i < EdgeColumns::column_floats(layout); i += line_floats)
#if HWY_ARCH_X86
    asm volatile("prefetchw %0" : : "m"(column[i]));
#else
    __builtin_prefetch(column + i, 1);
#endif
}

/// The same for those that a thread is going to read.
HWY_INLINE void prefetch_to_take(const BandLayout& layout, EdgeColumns& edge, std::size_t number,
                                 std::uint64_t pass) {
  constexpr std::size_t line_floats = 16;
  const float* column = edge.column(layout, pass, number);
  for (std::size_t i = 0; i < EdgeColumns::column_floats(layout); i += line_floats) hwy::Prefetch(column + i);
}

/// Copies a column of a partition that is complete in a pass, if it is a ghost of another one in the next
/// pass.
HWY_INLINE void leave_column(const BandLayout& layout, BandPartition& partition, std::size_t column,
                             std::uint64_t pass) {
  const auto leave = [&](EdgeColumns& edge, std::size_t number) HWY_ATTR {
    std::memcpy(edge.column(layout, pass + 1, number),
                partition.column(layout, Pair::state, column) + BandLayout::halo * layout.row_floats(),
                EdgeColumns::column_floats(layout) * sizeof(float));
    if (number + 1 == partition.ghosts) edge.pass.reach(pass + 1);
  };
  const std::size_t number = column - partition.first, behind = partition.first + partition.count - column;
  if (number < partition.ghosts && partition.left.exists()) leave(partition.left, number);
  if (behind <= partition.ghosts && partition.right.exists())
    leave(partition.right, partition.ghosts - behind);
}

}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
