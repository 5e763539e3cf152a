#include "garment/layers/cloth_contacts.h"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "geometry/triangle_tree.h"

namespace mssim {
namespace {

/// Two sub-patches with fewer cells than this in all do not get a task of their own: searching them takes
/// microseconds, as creating a task does.
constexpr std::uint32_t least_cells_of_task = 1024;

/// The search of boxes reaches a little farther than the comparison of distances, to cover rounding errors.
constexpr float box_reach = 1.01F;

constexpr std::uint32_t no_triangle = std::numeric_limits<std::uint32_t>::max();

NearestPoint nearest_on(const std::array<std::uint32_t, 3>& triangle, const Vec3<float>& point,
                        const Coordinates& position) {
  return nearest_point(point, point_of(position, triangle[0]), point_of(position, triangle[1]),
                       point_of(position, triangle[2]));
}

/// The panel's normal at a node; its length is proportional to the area of the cells around it.
Vec3<float> normal_at(const GarmentPanel& panel, std::uint32_t node, const Coordinates& position) {
  const std::uint32_t row = panel.row_of(node), column = panel.column_of(node);
  const auto at = [&](std::uint32_t r, std::uint32_t c) { return point_of(position, panel.node(r, c)); };
  const Vec3<float> along_row =
      at(row, std::min(column + 1, panel.columns - 1)) - at(row, column > 0 ? column - 1 : 0);
  const Vec3<float> along_column =
      at(std::min(row + 1, panel.rows - 1), column) - at(row > 0 ? row - 1 : 0, column);
  return cross(along_row, along_column);
}

/// Whether a point of a triangle lies on the border of its panel.
bool on_border(const GarmentPanel& panel, const std::array<std::uint32_t, 3>& triangle,
               const std::array<float, 3>& weight) {
  bool lowest = true, highest = true, leftmost = true, rightmost = true;
  for (std::size_t i = 0; i < 3; ++i) {
    if (weight[i] <= 0) continue;
    const std::uint32_t row = panel.row_of(triangle[i]), column = panel.column_of(triangle[i]);
    lowest = lowest && row == 0;
    highest = highest && row == panel.rows - 1;
    leftmost = leftmost && column == 0;
    rightmost = rightmost && column == panel.columns - 1;
  }
  return lowest || highest || leftmost || rightmost;
}

/// The contact of a node with its nearest triangle, if there is one. outward: 1 if the node belongs on the
/// side of the panel's normal, else -1.
std::optional<ClothContact> contact_of(const GarmentPanel& panel, std::uint32_t node, std::uint32_t nearest,
                                       float outward, const Coordinates& position) {
  const std::uint32_t cell = nearest / 2, row_length = panel.columns - 1;
  ClothContact contact{.node = node,
                       .triangle = panel.triangle(cell / row_length, cell % row_length, nearest % 2)};
  const NearestPoint point = nearest_on(contact.triangle, point_of(position, node), position);
  contact.weight = point.weight;
  const Vec3<float> first = point_of(position, contact.triangle[0]);
  Vec3<float> face =
      cross(point_of(position, contact.triangle[1]) - first, point_of(position, contact.triangle[2]) - first);
  if (std::ranges::any_of(point.weight, [](float weight) { return weight <= 0; })) {
    face = {};
    for (std::size_t i = 0; i < 3; ++i)
      face += point.weight[i] * normal_at(panel, contact.triangle[i], position);
  }
  face = outward * face;
  const bool right_side = dot(point.offset, face) >= 0;
  if (!right_side && on_border(panel, contact.triangle, point.weight)) return std::nullopt;
  const float distance = std::sqrt(point.distance_squared());
  contact.gap = right_side ? distance : -distance;
  // At smaller distances, rounding determines the direction of the offset.
  constexpr float least_distance = 1e-6F;
  contact.normal =
      distance > least_distance ? (1 / contact.gap) * point.offset : (1 / std::sqrt(dot(face, face))) * face;
  // NaN or infinite if the cloth has no area there, and so no normal.
  if (!std::isfinite(dot(contact.normal, contact.normal))) return std::nullopt;
  return contact;
}

}  // namespace

std::vector<PanelPair> layer_pairs(const Garment& garment) {
  std::vector<PanelPair> pairs;
  const auto panels = static_cast<std::uint32_t>(garment.panels.size());
  for (std::uint32_t inner = 0; inner < panels; ++inner)
    for (std::uint32_t outer = 0; outer < panels; ++outer)
      if (garment.panels[inner].layer < garment.panels[outer].layer) pairs.push_back({inner, outer});
  return pairs;
}

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
  for (std::uint32_t i = 0; i < row_parts; ++i)
    for (std::uint32_t j = 0; j < column_parts; ++j)
      blocks_.push_back({bound(whole.row_begin, whole.row_end, i, row_parts),
                         bound(whole.row_begin, whole.row_end, i + 1, row_parts),
                         bound(whole.column_begin, whole.column_end, j, column_parts),
                         bound(whole.column_begin, whole.column_end, j + 1, column_parts)});
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

ClothContactSearch::ClothContactSearch(const Garment& garment, double reach, int threads)
    : reach_(static_cast<float>(reach)), threads_(threads), found_(static_cast<std::size_t>(threads)) {
  std::uint32_t slots = 0;
  for (const auto& [inner, outer] : layer_pairs(garment)) {
    const GarmentPanel &inside = garment.panels[inner], &outside = garment.panels[outer];
    pairs_.push_back({boxes_of(inside), boxes_of(outside), slots});
    slots += outside.nodes() + inside.nodes();
  }
  slots_.resize(slots, Nearest{std::numeric_limits<float>::infinity(), no_triangle});
  for (std::uint32_t i = 0; i < boxes_.size(); ++i)
    for (const std::uint32_t block : boxes_[i].leaves()) leaves_.push_back({i, block});
}

std::uint32_t ClothContactSearch::boxes_of(const GarmentPanel& panel) {
  const auto known = std::ranges::find(boxes_, panel.first_node,
                                       [](const PanelBoxes& boxes) { return boxes.panel().first_node; });
  const auto index = static_cast<std::uint32_t>(known - boxes_.begin());
  if (known == boxes_.end()) boxes_.emplace_back(panel);
  return index;
}

std::span<const ClothContact> ClothContactSearch::find(const Coordinates& position) {
  contacts_.clear();
  if (pairs_.empty()) return contacts_;
#pragma omp parallel num_threads(threads_)
  {
#pragma omp for schedule(static)
    for (std::size_t i = 0; i < leaves_.size(); ++i)
      boxes_[leaves_[i].boxes].refit_leaf(leaves_[i].block, position);
#pragma omp for schedule(static)
    for (std::size_t i = 0; i < boxes_.size(); ++i) boxes_[i].refit_rest();
#pragma omp single
    for (const Pair& pair : pairs_) search(pair, 0, 0, position);
  }
  keep_nearest();
  make_contacts(position);
  return contacts_;
}

void ClothContactSearch::search(const Pair& pair, std::uint32_t inner_block, std::uint32_t outer_block,
                                const Coordinates& position) {
  const PanelBoxes &inner = boxes_[pair.inner], &outer = boxes_[pair.outer];
  const PanelBoxes::Block &inside = inner.blocks()[inner_block], &outside = outer.blocks()[outer_block];
  if (inside.children == 0 && outside.children == 0) {
    Candidates& found = found_[static_cast<std::size_t>(omp_get_thread_num())];
    test_nodes(outer, outer_block, inner, inner_block, pair.first_slot, position, found);
    test_nodes(inner, inner_block, outer, outer_block, pair.first_slot + outer.panel().nodes(), position,
               found);
    return;
  }
  const bool large = inside.cells() + outside.cells() >= least_cells_of_task;
  for (std::uint32_t i = 0; i < std::max(inside.children, 1U); ++i) {
    const std::uint32_t inner_part = inside.children > 0 ? inside.first_child + i : inner_block;
    for (std::uint32_t j = 0; j < std::max(outside.children, 1U); ++j) {
      const std::uint32_t outer_part = outside.children > 0 ? outside.first_child + j : outer_block;
      if (!near(inner.box(inner_part), outer.box(outer_part), box_reach * reach_)) continue;
      if (large) {
        // `pair` and `position` outlive the tasks, for which find() waits.
#pragma omp task firstprivate(inner_part, outer_part) shared(pair, position)
        search(pair, inner_part, outer_part, position);
      } else {
        search(pair, inner_part, outer_part, position);
      }
    }
  }
}

void ClothContactSearch::test_nodes(const PanelBoxes& of_nodes, std::uint32_t node_block,
                                    const PanelBoxes& of_triangles, std::uint32_t triangle_block,
                                    std::uint32_t first_slot, const Coordinates& position,
                                    Candidates& found) const {
  const GarmentPanel &panel = of_nodes.panel(), &other = of_triangles.panel();
  const PanelBoxes::Block& nodes = of_nodes.blocks()[node_block];
  const PanelBoxes::Block& cells = of_triangles.blocks()[triangle_block];
  const Box<float>& around = of_triangles.box(triangle_block);
  // A node belongs to the cell whose lower left node it is, or to the last cell on the upper and right
  // border.
  const std::uint32_t row_end = nodes.row_end + (nodes.row_end + 1 == panel.rows ? 1 : 0);
  const std::uint32_t column_end = nodes.column_end + (nodes.column_end + 1 == panel.columns ? 1 : 0);
  for (std::uint32_t row = nodes.row_begin; row < row_end; ++row)
    for (std::uint32_t column = nodes.column_begin; column < column_end; ++column) {
      const std::uint32_t node = panel.node(row, column);
      const Vec3<float> point = point_of(position, node);
      Nearest best{reach_ * reach_, no_triangle};
      const auto too_far = [&](const Box<float>& box) {
        return !(distance_squared(box, point) < box_reach * best.distance_squared);
      };
      if (too_far(around)) continue;
      for (std::uint32_t r = cells.row_begin; r < cells.row_end; ++r)
        for (std::uint32_t c = cells.column_begin; c < cells.column_end; ++c) {
          if (too_far(of_triangles.cell_box(r, c))) continue;
          for (const std::uint32_t half : {0U, 1U}) {
            const NearestPoint on_half = nearest_on(other.triangle(r, c, half), point, position);
            if (on_half.distance_squared() < best.distance_squared)
              best = {on_half.distance_squared(), 2 * (r * (other.columns - 1) + c) + half};
          }
        }
      if (best.triangle != no_triangle) found.push_back({first_slot + node - panel.first_node, best});
    }
}

void ClothContactSearch::keep_nearest() {
  // The minimum does not depend on the order in which tasks have found the candidates.
  for (Candidates& found : found_) {
    for (const Candidate& candidate : found)
      slots_[candidate.slot] = std::min(slots_[candidate.slot], candidate.nearest);
    found.clear();
  }
}

void ClothContactSearch::make_contacts(const Coordinates& position) {
  for (const Pair& pair : pairs_) {
    const GarmentPanel &inner = boxes_[pair.inner].panel(), &outer = boxes_[pair.outer].panel();
    const auto take = [&](std::uint32_t first_slot, const GarmentPanel& of_nodes, const GarmentPanel& other,
                          float outward) {
      for (std::uint32_t i = 0; i < of_nodes.nodes(); ++i) {
        Nearest& nearest = slots_[first_slot + i];
        if (nearest.triangle == no_triangle) continue;
        if (const auto contact =
                contact_of(other, of_nodes.first_node + i, nearest.triangle, outward, position))
          contacts_.push_back(*contact);
        nearest = {std::numeric_limits<float>::infinity(), no_triangle};
      }
    };
    take(pair.first_slot, outer, inner, 1);
    take(pair.first_slot + outer.nodes(), inner, outer, -1);
  }
}

}  // namespace mssim
