#include <algorithm>
#include <optional>
#include <vector>

#include "garment/contact/body_maps.h"
#include "garment/stepping/garment_grid.h"
#include "garment/stepping/list_dressing.h"
#include "laws/host_laws.h"

namespace mssim {
namespace {

template <class Real>
class SerialDressing final : public ListDressing<Vec3<Real>> {
 public:
  SerialDressing(const System& system, double dt_s)
      : ListDressing<Vec3<Real>>(system, dt_s),
        correction_rule_(correction_rule<Real>(rules_, dt_s)),
        closing_rule_(closing_rule<Real>(rules_, dt_s)),
        correction_order_(correction_order(garment_, system.springs)),
        layers_(layer_collision(system, garment_, 1)) {
    for (const SpringMaterial& material : system.materials)
      undamped_.push_back({.stiffness = static_cast<Real>(material.stiffness)});
  }

  int threads() const override { return 1; }

  void step(int count) override {
    for (int step = 0; step < count; ++step) {
      phase_ = phase_rule<Real>(system_, rules_, seaming_.progress.draping);
      add_spring_forces();
      add_external_forces();
      add_joint_forces();
      update_velocities();
      collide_layers();
      collide_with_body();
      correct_velocities();
      close_sewn_joints();
      hold_edges();
      move();
      seaming_.end_step(rules_, dt_s_);
    }
  }

 private:
  using Vector = Vec3<Real>;
  using Base = ListDressing<Vector>;
  using Base::system_, Base::garment_, Base::rules_, Base::dt_, Base::dt_s_, Base::nodes_, Base::force_,
      Base::inverse_mass_, Base::seaming_;
  using typename Base::Node;

  void add_spring_forces() {  // loop 1
    std::fill(force_.begin(), force_.end(), Vector{});
    for (const Spring& spring : system_.springs) {
      const Vector d = nodes_[spring.second].x - nodes_[spring.first].x;
      const auto law = linear_spring(undamped_[spring.kind], static_cast<Real>(spring.rest_length));
      const Vector force = spring_pull(dot(d, d), Real{0}, law) * d;
      force_[spring.first] += force;
      force_[spring.second] -= force;
    }
  }

  void add_external_forces() {  // loop 2; from here on, force_ holds accelerations
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      if (inverse_mass_[i] == 0) continue;
      force_[i] = node_acceleration_unfused(inverse_mass_[i] * force_[i], nodes_[i].v, phase_.damping,
                                            phase_.gravity);
    }
  }

  AtJoint<Vector> at(const Joint& joint, Vector Node::*of) const {
    return {nodes_[joint.node].*of, nodes_[joint.edge_first].*of, nodes_[joint.edge_second].*of};
  }
  AtJoint<Real> inverse_masses_at(const Joint& joint) const {
    return {inverse_mass_[joint.node], inverse_mass_[joint.edge_first], inverse_mass_[joint.edge_second]};
  }

  void add_joint_forces() {  // loop 3
    const double time_s = static_cast<double>(seaming_.steps) * dt_s_;
    for (std::size_t j = 0; j < garment_.joints.size(); ++j) {
      if (seaming_.sewn[j] != 0) continue;
      const Joint& joint = garment_.joints[j];
      const auto pull = pull_of_joint(rules_, joint, time_s, at(joint, &Node::x), inverse_masses_at(joint));
      if (!pull) {
        seaming_.sewn[j] = 1;
        continue;
      }
      force_[joint.node] += pull->node;
      force_[joint.edge_first] += pull->first;
      force_[joint.edge_second] += pull->second;
    }
  }

  void update_velocities() {  // loop 4
    for (std::size_t i = 0; i < nodes_.size(); ++i)
      if (inverse_mass_[i] != 0) nodes_[i].v += dt_ * force_[i];
  }

  void collide_layers() {
    if (!layers_) return;
    layers_->collide(
        dt_s_,
        [&](std::size_t i) {
          return NodeState{vec3_cast<float>(nodes_[i].x), vec3_cast<float>(nodes_[i].v)};
        },
        [&](std::size_t i, const NodeState& state) {
          nodes_[i] = {vec3_cast<Real>(state.position), vec3_cast<Real>(state.velocity)};
        });
  }

  void collide_with_body() {  // loop 4, too
    const Real push = static_cast<Real>(rules_.push_speed);
    free_ = inverse_mass_;
    for (const GarmentPanel& panel : garment_.panels) {
      const BodyMaps* const body = garment_.body_met_by(panel);
      if (body == nullptr) continue;
      for (std::size_t i = panel.first_node; i < panel.first_node + panel.nodes(); ++i) {
        if (inverse_mass_[i] == 0) continue;
        if (body->respond(nodes_[i].x, nodes_[i].v, phase_.friction, push, dt_)) free_[i] = 0;
      }
    }
  }

  void correct_velocities() {  // loop 5
    for (std::uint32_t sweep = 0; sweep < correction_sweeps(rules_); ++sweep) {
      if (sweep % 2 == 0)
        for (auto spring = correction_order_.begin(); spring != correction_order_.end(); ++spring)
          correct(system_.springs[*spring]);
      else
        for (auto spring = correction_order_.rbegin(); spring != correction_order_.rend(); ++spring)
          correct(system_.springs[*spring]);
    }
  }

  /// Limits the speed at which the ends of an over-elongated spring separate; nodes that friction holds stay.
  void correct(const Spring& spring) {
    Node &first = nodes_[spring.first], &second = nodes_[spring.second];
    const Vector d = second.x - first.x;
    const Real squared = dot(d, d);
    const Real limit = static_cast<Real>(spring.rest_length) * correction_rule_.limit;
    if (!(elongation_excess(squared, limit) > 0)) return;
    const Real first_free = free_[spring.first], second_free = free_[spring.second];
    const Real impulse = elongation_impulse(squared, dot(second.v - first.v, d), limit,
                                            correction_rule_.rate_per_s, first_free + second_free);
    first.v += first_free * impulse * d;
    second.v -= second_free * impulse * d;
  }

  /// Runs after the correction, which would reopen sewn joints: their ends move as one except for closing the
  /// gap.
  void close_sewn_joints() {
    for (std::size_t j = 0; j < garment_.joints.size(); ++j) {
      if (seaming_.sewn[j] == 0) continue;
      const Joint& joint = garment_.joints[j];
      const AtJoint<Vector> change =
          closing_of_joint(closing_rule_, static_cast<Real>(joint.edge_share), at(joint, &Node::x),
                           at(joint, &Node::v), inverse_masses_at(joint));
      nodes_[joint.node].v += change.node;
      nodes_[joint.edge_first].v += change.first;
      nodes_[joint.edge_second].v += change.second;
    }
  }

  void hold_edges() {
    if (!rules_.edge_held || seaming_.progress.draping) return;
    for (const GarmentPanel& panel : garment_.panels)
      for (std::uint32_t column = 0; column < panel.columns; ++column)
        nodes_[panel.node(panel.rows - 1, column)].v.y = 0;
  }

  void move() {  // loop 6
    const Floor& floor = system_.floor;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      if (inverse_mass_[i] == 0) continue;
      nodes_[i].x += dt_ * nodes_[i].v;
      touch_floor(nodes_[i].x, nodes_[i].v, static_cast<Real>(floor.height),
                  static_cast<Real>(floor.restitution), static_cast<Real>(floor.friction));
    }
  }

  std::vector<SpringConstants<Real>> undamped_;  ///< [kinds]
  std::vector<Real> free_;  ///< [nodes] inverse_mass_, but 0 for nodes that friction holds
  PhaseRule<Real> phase_{};
  CorrectionRule<Real> correction_rule_;
  ClosingRule<Real> closing_rule_;
  std::vector<std::uint32_t> correction_order_;
  std::optional<ClothClothCollision> layers_;
};

}  // namespace

std::unique_ptr<DressingBackend> make_serial_dressing(const System& system, const Integrator& integrator,
                                                      double dt_s, const ExecutionOptions& /*options*/) {
  require_semi_euler(integrator);
  return std::make_unique<SerialDressing<float>>(system, dt_s);
}

std::unique_ptr<DressingBackend> make_reference_dressing(const System& system, const Integrator& integrator,
                                                         double dt_s) {
  require_semi_euler(integrator);
  return std::make_unique<SerialDressing<double>>(system, dt_s);
}

}  // namespace mssim
