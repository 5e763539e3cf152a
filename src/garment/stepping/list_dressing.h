#pragma once

#include <cstdint>
#include <vector>

#include "garment/stepping/dressing_rules.h"

namespace mssim {

/// The nodes of a dressing as a list, its seams, and how both are set and read. Vector is a Vec3, or a type
/// with its operations that converts from and to it.
template <class Vector>
class ListDressing : public DressingBackend {
 public:
  void set_state(const State& state) override {
    for (std::size_t i = 0; i < nodes_.size(); ++i)
      nodes_[i] = {vec3_cast<Real>(state.position[i]), vec3_cast<Real>(state.velocity[i])};
    seaming_.start(garment_, state);
  }

  State state() const override {
    State state;
    for (const Node& node : nodes_)
      state.add(vec3_cast<double>(Vec3<Real>(node.x)), vec3_cast<double>(Vec3<Real>(node.v)));
    state.draped = seaming_.progress.draping;
    return state;
  }

  DressingProgress progress() const override { return seaming_.progress; }

 protected:
  using Real = decltype(dot(Vector(), Vector()));
  struct Node {
    Vector x;  ///< m
    Vector v;  ///< m/s
  };

  ListDressing(const System& system, double dt_s)
      : system_(system),
        garment_(std::get<Garment>(system.topology)),
        rules_(garment_.dressing),
        dt_(static_cast<Real>(dt_s)),
        dt_s_(dt_s),
        nodes_(system.nodes()),
        force_(system.nodes()) {
    for (const double mass : system.node_mass) inverse_mass_.push_back(static_cast<Real>(1 / mass));
    for (const std::uint32_t pin : system.pins) inverse_mass_[pin] = 0;
    ListDressing::set_state(system.start);
  }

  const System& system_;
  const Garment& garment_;
  const DressingSettings& rules_;
  const Real dt_;
  const double dt_s_;
  std::vector<Node> nodes_;
  std::vector<Vector> force_;       ///< [nodes] N
  std::vector<Real> inverse_mass_;  ///< [nodes] 1/kg, 0 for a pin
  Seaming seaming_;
};

}  // namespace mssim
