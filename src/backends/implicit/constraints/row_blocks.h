#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace mssim {

/// A small step of a cloth by blocks of four rows, in levels that wait for each other:
///
///     own        falling, springs along its rows, and between rows 0 and 1 and rows 2 and 3,
///     join       springs between the last row of the block before it and its row 0, and rows 1 and 2,
///     bend       bending springs from its rows 0 and 1,
///     bend_join  those from rows 2 and 3 of the block before it,
///     advance    x += h v.
///
/// A level of a block needs the level before it, of that block and of one neighbour. So a pass goes down the
/// cloth once, the levels of several small steps behind each other, each `lag` blocks behind the first.
enum class BlockLevel : std::size_t { own, join, bend, bend_join, advance };
inline constexpr std::size_t block_levels = 5;
inline constexpr std::size_t block_rows = 4;

inline std::size_t block_count(std::size_t rows) { return (rows + block_rows - 1) / block_rows; }

/// Fewest blocks that a thread needs for passes of so many small steps.
constexpr std::size_t least_blocks(std::size_t depth) { return 4 * depth; }

/// How many blocks a level of a small step stays behind the first level of the pass.
constexpr std::size_t lag(std::size_t small_step, BlockLevel level) {
  constexpr std::array<std::size_t, block_levels> behind{0, 0, 1, 1, 2};
  return 2 * small_step + behind[static_cast<std::size_t>(level)];
}

/// Blocks [begin, end) of a level that a thread can do without what its neighbours do in this pass: those of
/// its own, less some at each end that is not the cloth's.
struct BlockRange {
  std::size_t begin, end;
};

/// A thread's blocks of a cloth of `all` blocks.
struct BlockShare {
  std::size_t begin, end, all;

  BlockShare(std::size_t thread, std::size_t threads, std::size_t blocks)
      : begin(blocks * thread / threads), end(blocks * (thread + 1) / threads), all(blocks) {}

  /// What it can do alone.
  BlockRange alone(std::size_t small_step, BlockLevel level) const {
    constexpr std::array<std::size_t, block_levels> missing_before{0, 1, 1, 2, 2};
    const std::size_t before = 2 * small_step + missing_before[static_cast<std::size_t>(level)];
    return {begin == 0 ? 0 : begin + before, end == all ? all : end - lag(small_step, level)};
  }
};

}  // namespace mssim
