#include "garment/stepping/correction_order.h"

#include <algorithm>
#include <map>
#include <span>
#include <stdexcept>
#include <utility>

#include "garment/stepping/panel_stencil.h"

namespace mssim {
namespace {

constexpr auto directions = std::span(panel_stencil).first<limited_directions>();

using SpringNumbers = std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t>;

std::pair<std::uint32_t, std::uint32_t> key(std::uint32_t first, std::uint32_t second) {
  return std::minmax(first, second);
}

/// Appends the springs of a direction that a row owns.
void append_row(const GarmentPanel& panel, std::uint32_t row, const GridSpring& direction,
                const SpringNumbers& numbers, std::vector<std::uint32_t>& order) {
  const std::uint32_t other_row = row + static_cast<std::uint32_t>(direction.rows);
  for (std::uint32_t column = 0; column < panel.columns; ++column) {
    const std::int64_t other_column = std::int64_t{column} + direction.columns;
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
      for (const GridSpring& direction : directions)
        for (std::uint32_t row = blocks[block];
             row + static_cast<std::uint32_t>(direction.rows) < blocks[block + 1]; ++row)
          append_row(panel, row, direction, numbers, order);
    for (std::size_t block = 1; block + 1 < blocks.size(); ++block)
      for (const GridSpring& direction : directions)
        if (direction.rows != 0) append_row(panel, blocks[block] - 1, direction, numbers, order);
  }
  return order;
}

}  // namespace mssim
