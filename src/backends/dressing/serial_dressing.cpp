#include "backends/dressing/serial_dressing.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "backends/dressing/correction_order.h"
#include "backends/dressing/seam_force.h"
#include "backends/host_lines.h"
#include "contact/body_maps.h"

namespace mssim {
namespace {

template <class Real>
class SerialDressing final : public DressingBackend {
 public:
  SerialDressing(const System& system, double dt_s)
      : system_(system),
        garment_(std::get<Garment>(system.topology)),
        rules_(garment_.dressing),
        dt_(static_cast<Real>(dt_s)),
        dt_s_(dt_s),
        nodes_(system.nodes()),
        force_(system.nodes()),
        correction_order_(correction_order(garment_, system.springs)) {
    for (const SpringMaterial& material : system.materials)
      stiffness_.push_back(static_cast<Real>(material.stiffness));
    for (const double mass : system.node_mass) inverse_mass_.push_back(static_cast<Real>(1 / mass));
    for (const std::uint32_t pin : system.pins) inverse_mass_[pin] = 0;
    SerialDressing::set_state(system.start);
  }

  void set_state(const State& state) override {
    for (std::size_t i = 0; i < nodes_.size(); ++i)
      nodes_[i] = {vec3_cast<Real>(state.position[i]), vec3_cast<Real>(state.velocity[i])};
    sewn_.assign(garment_.joints.size(), 0);
    open_joints_ = garment_.joints.size();
    draping_ = garment_.joints.empty();
    steps_ = seamed_at_ = 0;
  }

  State state() const override {
    State state;
    for (const Node& node : nodes_) {
      state.position.push_back(vec3_cast<double>(node.x));
      state.velocity.push_back(vec3_cast<double>(node.v));
    }
    return state;
  }

  std::string device() const override { return "cpu"; }
  int threads() const override { return 1; }
  DressingProgress progress() const override { return {open_joints_, draping_, seamed_at_}; }

  void step(int count) override {
    for (int step = 0; step < count; ++step) {
      add_spring_forces();
      add_external_forces();
      add_joint_forces();
      update_velocities();
      correct_velocities();
      close_sewn_joints();
      move();
      end_step();
    }
  }

 private:
  using Vector = Vec3<Real>;
  struct Node {
    Vector x;  ///< m
    Vector v;  ///< m/s
  };

  void add_spring_forces() {  // loop 1
    std::fill(force_.begin(), force_.end(), Vector{});
    for (const Spring& spring : system_.springs) {
      const Vector d = nodes_[spring.second].x - nodes_[spring.first].x;
      const Real stiffness = stiffness_[spring.kind];
      const Vector force = spring_pull(dot(d, d), Real{0}, stiffness,
                                       stiffness * static_cast<Real>(spring.rest_length), Real{0}) *
                           d;
      force_[spring.first] += force;
      force_[spring.second] -= force;
    }
  }

  void add_external_forces() {  // loop 2, per mass: what is added up is an acceleration from here on
    const Real damping = static_cast<Real>(draping_ ? system_.viscous_damping : rules_.seaming_damping);
    const Real gravity = static_cast<Real>((draping_ ? 1 : rules_.seaming_gravity) * system_.gravity);
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      if (inverse_mass_[i] == 0) continue;
      force_[i] = inverse_mass_[i] * force_[i] - damping * nodes_[i].v;
      force_[i].y -= gravity;
    }
  }

  Vector gap_of(const Joint& joint) const {
    return between(joint, nodes_[joint.edge_first].x, nodes_[joint.edge_second].x) - nodes_[joint.node].x;
  }
  static Vector between(const Joint& joint, const Vector& first, const Vector& second) {
    return first + static_cast<Real>(joint.edge_share) * (second - first);
  }

  void add_joint_forces() {  // loop 3
    const double time_s = static_cast<double>(steps_) * dt_s_;
    for (std::size_t j = 0; j < garment_.joints.size(); ++j) {
      if (sewn_[j] != 0) continue;
      const Joint& joint = garment_.joints[j];
      const Vector gap = gap_of(joint);
      const Real distance = std::sqrt(dot(gap, gap));
      if (distance < static_cast<Real>(rules_.sewn_gap)) {
        sewn_[j] = 1;
        --open_joints_;
        continue;
      }
      const Vector force = static_cast<Real>(seam_force(rules_, joint, time_s)) / distance * gap;
      const Real share = static_cast<Real>(joint.edge_share);
      force_[joint.node] += inverse_mass_[joint.node] * force;
      force_[joint.edge_first] -= (1 - share) * inverse_mass_[joint.edge_first] * force;
      force_[joint.edge_second] -= share * inverse_mass_[joint.edge_second] * force;
    }
  }

  void update_velocities() {  // loop 4
    const Real friction = static_cast<Real>(draping_ ? rules_.friction : 0);
    const Real push = static_cast<Real>(rules_.push_speed);
    free_.resize(nodes_.size());
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      free_[i] = inverse_mass_[i];
      if (inverse_mass_[i] == 0) continue;
      Node& node = nodes_[i];
      node.v += dt_ * force_[i];
      if (garment_.body && garment_.body->respond(node.x, node.v, friction, push, dt_)) free_[i] = 0;
    }
  }

  void correct_velocities() {  // loop 5
    if (rules_.correction == VelocityCorrection::none) return;
    for (std::uint32_t sweep = 0; sweep < rules_.correction_sweeps; ++sweep) {
      if (sweep % 2 == 0)
        for (auto spring = correction_order_.begin(); spring != correction_order_.end(); ++spring)
          correct(system_.springs[*spring]);
      else
        for (auto spring = correction_order_.rbegin(); spring != correction_order_.rend(); ++spring)
          correct(system_.springs[*spring]);
    }
  }

  /// Lets the ends of an over-elongated spring part no faster than the rule allows; a node that friction
  /// holds stays.
  void correct(const Spring& spring) {
    Node &first = nodes_[spring.first], &second = nodes_[spring.second];
    const Vector d = second.x - first.x;
    const Real squared = dot(d, d);
    const Real limit =
        static_cast<Real>(spring.rest_length) * static_cast<Real>(1 + rules_.correction_threshold);
    const Real mobility = free_[spring.first] + free_[spring.second];
    if (!(squared > limit * limit) || mobility == 0) return;
    const Real length = std::sqrt(squared);
    const Real wanted = rules_.correction == VelocityCorrection::bounded
                            ? static_cast<Real>(rules_.correction_rate) * (length - limit) / dt_
                            : Real{0};
    const Real parting = dot(second.v - first.v, d) / length + wanted;  // m/s, beyond what is allowed
    if (!(parting > 0)) return;
    const Vector impulse = parting / (mobility * length) * d;
    first.v += free_[spring.first] * impulse;
    second.v -= free_[spring.second] * impulse;
  }

  /// After the correction, which would open them again: the ends of a sewn joint move as one but for what
  /// closes its gap.
  void close_sewn_joints() {
    for (std::size_t j = 0; j < garment_.joints.size(); ++j) {
      if (sewn_[j] == 0) continue;
      const Joint& joint = garment_.joints[j];
      Node &node = nodes_[joint.node], &first = nodes_[joint.edge_first], &second = nodes_[joint.edge_second];
      const Real share = static_cast<Real>(joint.edge_share);
      const Real node_mobility = inverse_mass_[joint.node];
      const Real first_mobility = (1 - share) * inverse_mass_[joint.edge_first];
      const Real second_mobility = share * inverse_mass_[joint.edge_second];
      // The two ends of an edge may be the same node.
      const Real mobility = node_mobility + (joint.edge_first == joint.edge_second
                                                 ? inverse_mass_[joint.edge_first]
                                                 : (1 - share) * first_mobility + share * second_mobility);
      if (mobility == 0) continue;
      const Vector gap = gap_of(joint);
      const Real distance = std::sqrt(dot(gap, gap));
      const Real closing = std::min(static_cast<Real>(rules_.closing_share) / dt_,
                                    static_cast<Real>(rules_.closing_speed) / (distance + Real{1e-9F}));
      const Vector impulse =
          Real{1} / mobility * (between(joint, first.v, second.v) - node.v + closing * gap);
      node.v += node_mobility * impulse;
      first.v -= first_mobility * impulse;
      second.v -= second_mobility * impulse;
    }
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

  void end_step() {
    ++steps_;
    if (draping_) return;
    if (open_joints_ > 0 && static_cast<double>(steps_) * dt_s_ < rules_.longest_seaming_s) return;
    std::fill(sewn_.begin(), sewn_.end(), std::uint8_t{1});
    open_joints_ = 0;
    draping_ = true;
    seamed_at_ = steps_;
  }

  const System& system_;
  const Garment& garment_;
  const Dressing& rules_;
  Real dt_;
  double dt_s_;
  std::vector<Node> nodes_;
  std::vector<Vector> force_;       ///< [nodes] N, from loop 2 on m/s^2
  std::vector<Real> stiffness_;     ///< [kinds] N/m
  std::vector<Real> inverse_mass_;  ///< [nodes] 1/kg, 0 for a pin
  std::vector<Real> free_;          ///< [nodes] the same, 0 for what friction holds, too
  std::vector<std::uint32_t> correction_order_;
  std::vector<std::uint8_t> sewn_;  ///< [joints]
  std::size_t open_joints_ = 0;
  bool draping_ = false;
  std::int64_t steps_ = 0, seamed_at_ = 0;
};

}  // namespace

std::unique_ptr<DressingBackend> make_serial_dressing(const System& system, const Integrator& integrator,
                                                      double dt_s) {
  require_semi_euler(integrator);
  return std::make_unique<SerialDressing<float>>(system, dt_s);
}

std::unique_ptr<DressingBackend> make_reference_dressing(const System& system, const Integrator& integrator,
                                                         double dt_s) {
  require_semi_euler(integrator);
  return std::make_unique<SerialDressing<double>>(system, dt_s);
}

}  // namespace mssim
