#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "garment/garment.h"
#include "garment/layers/panel_boxes.h"
#include "garment/layers/panel_layers.h"

namespace mssim {

/// A node of one panel near a triangle of another.
struct ClothContact {
  std::uint32_t node = 0;
  std::array<std::uint32_t, 3> triangle{};  ///< nodes
  std::array<float, 3> weight{};            ///< barycentric, of the triangle's point nearest to the node
  Vec3<float> normal{};                     ///< unit, from the triangle to the side where the node belongs
  float gap = 0;                            ///< m, from the triangle along the normal; negative: wrong side

  bool operator==(const ClothContact&) const = default;
};

/// Finds where panels come near each other: every node of one panel of a pair against all triangles of the
/// other panel, both ways, of which the nearest counts. Edges are not tested against edges: cells must be
/// fine enough that two edges do not cross while all nodes keep their distance.
///
/// A cell's triangles are (low left, low right, high right) and (low left, high right, high left).
///
/// The right side of an inner panel for nodes of the outer one is where its normal points (ClothLayers), that
/// of an outer panel for nodes of the inner one is the other. The nearest point of a triangle's inside is
/// told by the triangle's normal, that on an edge or corner by the normals at its nodes, so that a fold does
/// not turn sides over. A node beyond the border of a panel, that is, whose nearest point lies on it, is a
/// contact on the right side only: the panel says nothing about where that node belongs, but has a rim.
class ClothContactSearch {
 public:
  /// `nodes`: of the whole system. Nodes nearer than `reach` (m, positive) to a triangle are contacts. Throws
  /// std::invalid_argument where validate_layers does, or where reach or threads are not positive.
  ClothContactSearch(const Garment& garment, const ClothLayers& layers, std::size_t nodes, double reach,
                     int threads);

  /// The contacts in these positions, pair by pair, those of the outer panel's nodes first, in ascending
  /// order of nodes; the same to the last bit for any number of threads. They stay until the next call.
  /// Positions that are not finite are near nothing.
  std::span<const ClothContact> find(const Coordinates& position);

 private:
  struct Pair {
    std::uint32_t inner, outer;  // indices into boxes_
    std::uint32_t first_slot;    // one for each outer node, then one for each inner node
  };
  struct Leaf {
    std::uint32_t boxes, block;
  };
  struct Nearest {  // triangle of a slot's node
    float distance_squared;
    std::uint32_t triangle;  // 2 * cell + half

    bool operator<(const Nearest& other) const {
      return distance_squared < other.distance_squared ||
             (distance_squared == other.distance_squared && triangle < other.triangle);
    }
  };
  struct Candidate {
    std::uint32_t slot;
    Nearest nearest;
  };
  using Candidates = std::vector<Candidate>;

  std::uint32_t boxes_of(const GarmentPanel& panel);
  void search(const Pair& pair, std::uint32_t inner_block, std::uint32_t outer_block,
              const Coordinates& position);
  void test_nodes(const PanelBoxes& of_nodes, std::uint32_t node_block, const PanelBoxes& of_triangles,
                  std::uint32_t triangle_block, std::uint32_t first_slot, const Coordinates& position,
                  Candidates& found) const;
  void keep_nearest();
  void make_contacts(const Coordinates& position);

  const float reach_;
  const int threads_;
  std::vector<PanelBoxes> boxes_;  // of the panels that are in pairs
  std::vector<float> outward_;     // [boxes] 1, or -1 where the panel is mirrored
  std::vector<Leaf> leaves_;       // of all boxes
  std::vector<Pair> pairs_;        // [pairs]
  std::vector<Nearest> slots_;     // [slots] the nearest triangle of each node of each pair
  std::vector<Candidates> found_;  // [threads]
  std::vector<ClothContact> contacts_;
};

}  // namespace mssim
