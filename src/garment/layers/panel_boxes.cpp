#include "garment/layers/panel_boxes.h"

#include <cstddef>

namespace mssim {
PanelBoxes::PanelBoxes(const GarmentPanel& panel) : panel_(panel) {
  blocks_.push_back({0, panel.rows - 1, 0, panel.columns - 1});
  for (std::uint32_t block = 0; block < blocks_.size(); ++block) split(block);
  boxes_.resize(blocks_.size());
  cell_boxes_.resize(blocks_.front().cells());
}

void PanelBoxes::split(std::uint32_t block) {
  const Block whole = blocks_[block];
  const auto parts = [](std::uint32_t begin, std::uint32_t end) { return end - begin > leaf_side ? 2U : 1U; };
  const std::uint32_t row_parts = parts(whole.row_begin, whole.row_end);
  const std::uint32_t column_parts = parts(whole.column_begin, whole.column_end);
  if (row_parts * column_parts == 1) {
    leaves_.push_back(block);
    return;
  }
  blocks_[block].first_child = static_cast<std::uint32_t>(blocks_.size());
  blocks_[block].children = row_parts * column_parts;
  const auto bound = [](std::uint32_t begin, std::uint32_t end, std::uint32_t part, std::uint32_t of) {
    return begin + (end - begin) * part / of;
  };
  for (std::uint32_t i = 0; i < row_parts; ++i) {
    for (std::uint32_t j = 0; j < column_parts; ++j)
      blocks_.push_back({bound(whole.row_begin, whole.row_end, i, row_parts),
                         bound(whole.row_begin, whole.row_end, i + 1, row_parts),
                         bound(whole.column_begin, whole.column_end, j, column_parts),
                         bound(whole.column_begin, whole.column_end, j + 1, column_parts)});
  }
}

void PanelBoxes::refit_leaf(std::uint32_t leaf, const Coordinates& position) {
  const Block& cells = blocks_[leaf];
  const auto at = [&](std::uint32_t row, std::uint32_t column) {
    const Vec3<float> point = point_of(position, panel_.node(row, column));
    return Box<float>{point, point};
  };
  for (std::uint32_t row = cells.row_begin; row < cells.row_end; ++row) {
    Box<float> left = united(at(row, cells.column_begin), at(row + 1, cells.column_begin));
    for (std::uint32_t column = cells.column_begin; column < cells.column_end; ++column) {
      const Box<float> right = united(at(row, column + 1), at(row + 1, column + 1));
      Box<float>& cell = cell_boxes_[row * (panel_.columns - 1) + column];
      cell = united(left, right);
      const bool first = row == cells.row_begin && column == cells.column_begin;
      boxes_[leaf] = first ? cell : united(boxes_[leaf], cell);
      left = right;
    }
  }
}

void PanelBoxes::refit_rest() {
  for (std::size_t block = blocks_.size(); block-- > 0;) {
    const Block& parent = blocks_[block];
    if (parent.children == 0) continue;
    boxes_[block] = boxes_[parent.first_child];
    for (std::uint32_t i = 1; i < parent.children; ++i)
      boxes_[block] = united(boxes_[block], boxes_[parent.first_child + i]);
  }
}

}  // namespace mssim
