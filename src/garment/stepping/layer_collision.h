#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "garment/layers/cloth_cloth.h"
#include "model/system.h"

namespace mssim {

/// A node within a step.
struct NodeState {
  Vec3<float> position;  ///< m
  Vec3<float> velocity;  ///< m/s
};

/// What the layers of a garment do to each other in a step, after loop 4 has updated velocities and before
/// the body is met, which has the last word about the innermost layer. Works on a copy of the nodes: a
/// backend gives its own and takes back those that have met others.
class LayerCollision {
 public:
  /// Fewer nodes are searched by one thread: that takes less than OpenMP's threads may take to meet where
  /// other programs run, too (backends/threads/spin_wait.h).
  static constexpr std::size_t least_shared_nodes = 16'384;

  /// `garment.touching` is there. Throws std::invalid_argument where ClothClothCollision does.
  LayerCollision(const System& system, const Garment& garment, int threads);

  /// That work on a collision, 1 or as many as it was given; they form a team of their own.
  int threads() const { return threads_; }

  /// For a step of dt_s: NodeState read(node) of every node, in any order and by several threads;
  /// write(node, NodeState) of those that have changed, by one.
  template <class Read, class Write>
  void collide(double dt_s, const Read& read, const Write& write) {
    const auto nodes = static_cast<std::int64_t>(position_[0].size());
#pragma omp parallel for schedule(static) num_threads(threads_)
    for (std::int64_t i = 0; i < nodes; ++i)
      put(static_cast<std::size_t>(i), read(static_cast<std::size_t>(i)));
    respond(dt_s);
    for (const ClothContact& contact : collision_.contacts()) {
      write(contact.node, at(contact.node));
      for (const std::uint32_t node : contact.triangle) write(node, at(node));
    }
  }

 private:
  void put(std::size_t node, const NodeState& state);
  NodeState at(std::size_t node) const;
  void respond(double dt_s);

  int threads_;
  std::array<std::vector<float>, 3> position_, velocity_;  // [nodes]
  ClothClothCollision collision_;
};

/// None for a garment whose layers do not touch.
std::optional<LayerCollision> layer_collision(const System& system, const Garment& garment, int threads);

}  // namespace mssim
