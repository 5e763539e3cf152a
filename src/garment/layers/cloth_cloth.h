#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "garment/garment.h"
#include "garment/layers/cloth_contacts.h"

namespace mssim {

/// The state that a collision changes, as structures of arrays: x, y, z, each [nodes].
struct NodeArrays {
  std::array<std::span<float>, 3> position;  ///< m
  std::array<std::span<float>, 3> velocity;  ///< m/s
};

/// A node within a step.
struct NodeState {
  Vec3<float> position;  ///< m
  Vec3<float> velocity;  ///< m/s
};

/// Collisions between different panels (Vassilev, "Cloth-cloth collision detection"): finds the contacts of
/// the pairs of layers and responds to each. With w the triangle's weights, a contact is a node and a point
/// of a triangle; an impulse j (N s) along its normal, or across, changes the node's velocity by j/m and
/// those of the triangle's nodes by -w j/m, which conserves momentum. For every contact, in the order in
/// which ClothContactSearch gives them, so that the result is the same to the last bit for any number of
/// threads:
///
/// - what approaches along the normal stops (an inelastic impact), and what slides across loses speed by an
///   impulse of at most friction times the one along the normal;
/// - what is nearer than the thickness, or on the wrong side, is moved apart in inverse proportion to mass.
///
/// A layer that crosses by more than the thickness is not found any more and stays across: thickness must
/// exceed what layers approach in a step. To be done after the velocities' update and before the body's
/// collision, which then has the last word about the inner layer.
class ClothClothCollision {
 public:
  /// node_mass: [nodes] kg, positive; infinite for a node that is held. With a garment of one layer,
  /// collide() does nothing. Throws std::invalid_argument, in one sentence, for settings out of their ranges
  /// and for a mass that is not positive.
  ClothClothCollision(const Garment& garment, std::span<const float> node_mass,
                      const ClothClothSettings& settings, int threads);

  /// That work on a collision; they form a team of their own.
  int threads() const { return threads_; }

  /// Finds the contacts and responds, for a step of dt (s), on a copy of the nodes: NodeState read(node) of
  /// every node, in any order and by several threads; write(node, NodeState) of those that have changed, by
  /// one.
  template <class Read, class Write>
  void collide(double dt, const Read& read, const Write& write) {
    const auto nodes = static_cast<std::int64_t>(inverse_mass_.size());
#pragma omp parallel for schedule(static) num_threads(threads_)
    for (std::int64_t i = 0; i < nodes; ++i)
      put(static_cast<std::size_t>(i), read(static_cast<std::size_t>(i)));
    collide({{position_[0], position_[1], position_[2]}, {velocity_[0], velocity_[1], velocity_[2]}}, dt);
    for (const ClothContact& contact : contacts_) {
      write(contact.node, at(contact.node));
      for (const std::uint32_t node : contact.triangle) write(node, at(node));
    }
  }

  /// Finds the contacts and responds, for a step of dt (s). Throws std::invalid_argument if an array has
  /// another size than node_mass.
  void collide(const NodeArrays& nodes, double dt);

  /// Those of the last collide(), as they were before the response.
  std::span<const ClothContact> contacts() const { return contacts_; }

 private:
  void put(std::size_t node, const NodeState& state);
  NodeState at(std::size_t node) const;
  void stop_approach(const ClothContact& contact, const NodeArrays& nodes) const;
  void push_apart(const ClothContact& contact, const NodeArrays& nodes, float farthest) const;
  float inverse_mass_of(const ClothContact& contact) const;
  void move(const ClothContact& contact, const std::array<std::span<float>, 3>& of,
            const Vec3<float>& impulse) const;

  const ClothClothSettings settings_;
  int threads_;
  std::vector<float> inverse_mass_;  // [nodes] 1/kg
  ClothContactSearch search_;
  std::span<const ClothContact> contacts_;
  std::array<std::vector<float>, 3> position_, velocity_;  // [nodes] copies
};

}  // namespace mssim
