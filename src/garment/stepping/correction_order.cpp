#include "garment/stepping/correction_order.h"

#include <algorithm>
#include <array>
#include <map>
#include <stdexcept>
#include <utility>

namespace mssim {
namespace {

/// From the lower row's node of a spring to the other: row, column. A row's own springs go to the right.
constexpr std::array<std::array<int, 2>, 4> directions{{{0, 1}, {1, 0}, {1, 1}, {1, -1}}};

using SpringNumbers = std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t>;

std::pair<std::uint32_t, std::uint32_t> key(std::uint32_t first, std::uint32_t second) {
  return std::minmax(first, second);
}

/// Appends the springs of a direction that a row owns.
void append_row(const GarmentPanel& panel, std::uint32_t row, const std::array<int, 2>& direction,
                const SpringNumbers& numbers, std::vector<std::uint32_t>& order) {
  const std::uint32_t other_row = row + static_cast<std::uint32_t>(direction[0]);
  for (std::uint32_t column = 0; column < panel.columns; ++column) {
    const std::int64_t other_column = std::int64_t{column} + direction[1];
    if (other_column < 0 || other_column >= panel.columns) continue;
    const auto found = numbers.find(
        key(panel.node(row, column), panel.node(other_row, static_cast<std::uint32_t>(other_column))));
    if (found == numbers.end())
      throw std::invalid_argument("panel " + panel.name + " misses a spring of its stencil");
    order.push_back(found->second);
  }
}

}  // namespace

std::vector<std::uint32_t> correction_blocks(const GarmentPanel& panel) {
  std::vector<std::uint32_t> begins{0};
  for (std::uint32_t row = correction_block_rows; row + correction_block_rows <= panel.rows;
       row += correction_block_rows)
    begins.push_back(row);
  begins.push_back(panel.rows);
  return begins;
}

std::vector<std::uint32_t> correction_order(const Garment& garment, const std::vector<Spring>& springs) {
  SpringNumbers numbers;
  for (std::uint32_t spring = 0; spring < springs.size(); ++spring)
    numbers[key(springs[spring].first, springs[spring].second)] = spring;
  std::vector<std::uint32_t> order;
  for (const GarmentPanel& panel : garment.panels) {
    const std::vector<std::uint32_t> blocks = correction_blocks(panel);
    for (std::size_t block = 0; block + 1 < blocks.size(); ++block)
      for (const auto& direction : directions)
        for (std::uint32_t row = blocks[block];
             row + static_cast<std::uint32_t>(direction[0]) < blocks[block + 1]; ++row)
          append_row(panel, row, direction, numbers, order);
    for (std::size_t block = 1; block + 1 < blocks.size(); ++block)
      for (const auto& direction : directions)
        if (direction[0] != 0) append_row(panel, blocks[block] - 1, direction, numbers, order);
  }
  return order;
}

}  // namespace mssim
