#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "garment/garment.h"
#include "garment/layers/cloth_contacts.h"

namespace mssim {

/// A node within a step.
struct NodeState {
  Vec3<float> position;  ///< m
  Vec3<float> velocity;  ///< m/s
};

/// Collisions between different panels (Vassilev, "Cloth-cloth collision detection"): finds the contacts of
/// the pairs of layers and responds to each. A contact is a node and a point of a triangle, with weights w of
/// the triangle's nodes. An impulse j (N s) along its normal, or across, changes the node's velocity by j/m
/// and those of the triangle's nodes by -w j/m, which conserves momentum. Contacts are processed in the order
/// of ClothContactSearch, so that the result is bitwise identical for every number of threads:
///
/// - an approach along the normal stops (an inelastic impact), and friction slows sliding by at most the
///   friction coefficient times the normal impulse;
/// - nodes nearer than the thickness, or on the wrong side, are moved apart in inverse proportion to mass.
///
/// A layer that has crossed by more than the thickness is no longer found and stays there: the thickness must
/// exceed the approach of layers per step. Call it after the update of velocities and before contact with the
/// body, so that the body decides last about the inner layer.
class ClothClothCollision {
 public:
  /// node_mass: [nodes] kg, positive; infinite for a pin. collide() does nothing for a garment of one layer.
  /// Throws std::invalid_argument for settings out of range and for a mass that is not positive.
  ClothClothCollision(const Garment& garment, std::span<const float> node_mass,
                      const ClothClothSettings& settings, int threads);

  /// Number of threads of a collision, which are a separate team.
  int threads() const { return threads_; }

  /// Finds the contacts and responds, for a step of dt (s), on a copy of the nodes. Several threads call
  /// NodeState read(node) for all nodes, in any order; one calls write(node, NodeState) for those that have
  /// changed.
  template <class Read, class Write>
  void collide(double dt, const Read& read, const Write& write) {
    const auto nodes = static_cast<std::int64_t>(inverse_mass_.size());
#pragma omp parallel for schedule(static) num_threads(threads_)
    for (std::int64_t i = 0; i < nodes; ++i)
      put(static_cast<std::size_t>(i), read(static_cast<std::size_t>(i)));
    respond(dt);
    for (const ClothContact& contact : contacts_) {
      write(contact.node, at(contact.node));
      for (const std::uint32_t node : contact.triangle) write(node, at(node));
    }
  }

  /// The contacts of the last collide(), before the response.
  std::span<const ClothContact> contacts() const { return contacts_; }

 private:
  using Arrays = std::array<std::vector<float>, 3>;  // x, y, z, each [nodes]

  void put(std::size_t node, const NodeState& state);
  NodeState at(std::size_t node) const;
  /// Finds the contacts and responds, for a step of dt (s).
  void respond(double dt);
  void stop_approach(const ClothContact& contact);
  void push_apart(const ClothContact& contact, float farthest);
  static Vec3<float> difference(const ClothContact& contact, const Arrays& of);
  float inverse_mass_of(const ClothContact& contact) const;
  void move(const ClothContact& contact, Arrays& of, const Vec3<float>& impulse) const;

  const ClothClothSettings settings_;
  int threads_;
  std::vector<float> inverse_mass_;  // [nodes] 1/kg
  ClothContactSearch search_;
  std::span<const ClothContact> contacts_;
  Arrays position_, velocity_;  // copies, m and m/s
};

}  // namespace mssim
