#include "garment/stepping/published_dressing.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "garment/contact/body_maps.h"
#include "garment/stepping/list_dressing.h"
#include "laws/host_laws.h"

namespace mssim {
namespace {

/// A point or vector in one register of four floats, the last of which is 0. NEON and every x86-64 have such
/// registers. The compiler generates the instructions, as it does for intrinsic functions.
class Vec3InRegister {
  using Lanes [[gnu::vector_size(16)]] = float;

 public:
  Vec3InRegister() = default;
  Vec3InRegister(float x, float y, float z) : lanes_{x, y, z, 0} {}
  Vec3InRegister(const Vec3<float>& a) : Vec3InRegister(a.x, a.y, a.z) {}
  operator Vec3<float>() const { return {lanes_[0], lanes_[1], lanes_[2]}; }

  friend Vec3InRegister operator+(Vec3InRegister a, Vec3InRegister b) {
    return Vec3InRegister(a.lanes_ + b.lanes_);
  }
  friend Vec3InRegister operator-(Vec3InRegister a, Vec3InRegister b) {
    return Vec3InRegister(a.lanes_ - b.lanes_);
  }
  friend Vec3InRegister operator*(float s, Vec3InRegister a) { return Vec3InRegister(s * a.lanes_); }
  Vec3InRegister& operator+=(Vec3InRegister a) { return *this = *this + a; }
  Vec3InRegister& operator-=(Vec3InRegister a) { return *this = *this - a; }
  /// Adds in the order of dot() of Vec3, so that both are bitwise identical.
  friend float dot(Vec3InRegister a, Vec3InRegister b) {
    const Lanes products = a.lanes_ * b.lanes_;
    return products[0] + products[1] + products[2];
  }

 private:
  explicit Vec3InRegister(Lanes lanes) : lanes_(lanes) {}
  Lanes lanes_{};
};

/// Order in which threads process things that write to nodes: rounds of batches without a common node.
/// Processing a round's batches one after the other gives the same result.
struct ThreadSafeOrder {
  std::vector<std::uint32_t> things;  ///< batch after batch; within a batch in their original order
  std::vector<std::size_t> batches;   ///< [batches + 1] start of each in `things`
  std::vector<std::size_t> rounds;    ///< [rounds + 1] start of each in `batches`
};

/// `nodes_of`: the nodes to which a thing writes.
template <class NodesOf>
ThreadSafeOrder thread_safe_order(std::size_t nodes, std::size_t count, std::size_t batch_size,
                                  const NodesOf& nodes_of) {
  ThreadSafeOrder order{{}, {0}, {0}};
  std::vector<std::size_t> begins;
  for (std::size_t begin = 0; begin < count; begin += batch_size) begins.push_back(begin);
  while (!begins.empty()) {
    std::vector<std::uint8_t> taken(nodes);
    std::vector<std::size_t> later;
    for (const std::size_t begin : begins) {
      const std::size_t end = std::min(begin + batch_size, count);
      const auto for_all = [&](const auto& act) {
        for (std::size_t thing = begin; thing < end; ++thing)
          for (const std::uint32_t node : nodes_of(thing)) act(node);
      };
      bool free = true;
      for_all([&](std::uint32_t node) { free = free && taken[node] == 0; });
      if (!free) {
        later.push_back(begin);
        continue;
      }
      for_all([&](std::uint32_t node) { taken[node] = 1; });
      for (std::size_t thing = begin; thing < end; ++thing)
        order.things.push_back(static_cast<std::uint32_t>(thing));
      order.batches.push_back(order.things.size());
    }
    order.rounds.push_back(order.batches.size() - 1);
    begins = std::move(later);
  }
  return order;
}

/// Large enough to be worth an iteration of a `parallel for`, and small enough to give many threads work for
/// small jeans.
constexpr std::size_t springs_of_a_batch = 128, joints_of_a_batch = 16;

template <class Vector, bool parallel>
class PublishedLoops final : public ListDressing<Vector> {
 public:
  PublishedLoops(const System& system, double dt_s, int threads)
      : ListDressing<Vector>(system, dt_s),
        threads_(parallel ? std::max(1, threads) : 1),
        spring_order_(thread_safe_order(system.nodes(), system.springs.size(), springs_of_a_batch,
                                        [&](std::size_t i) {
                                          const Spring& spring = system.springs[i];
                                          return std::array{spring.first, spring.second};
                                        })),
        joint_order_(thread_safe_order(system.nodes(), garment_.joints.size(), joints_of_a_batch,
                                       [&](std::size_t i) {
                                         const Joint& joint = garment_.joints[i];
                                         return std::array{joint.node, joint.edge_first, joint.edge_second};
                                       })),
        sewn_stiffness_(garment_.joints.size()) {
    for (const double mass : system.node_mass) mass_.push_back(static_cast<Real>(mass));
    const Real limit = 1 + static_cast<Real>(rules_.correction_threshold);
    for (const std::uint32_t i : spring_order_.things) {
      const Spring& spring = system.springs[i];
      const auto rest = static_cast<Real>(spring.rest_length);
      const auto stiffness = static_cast<Real>(system.materials[spring.kind].stiffness);
      springs_.push_back(
          {spring.first, spring.second, linear_spring<Real>({.stiffness = stiffness}, rest), rest * limit});
    }
    std::vector<double> stiffest(system.nodes());
    for (const Spring& spring : system.springs)
      for (const std::uint32_t node : {spring.first, spring.second})
        stiffest[node] = std::max(stiffest[node], system.materials[spring.kind].stiffness);
    for (std::size_t j = 0; j < sewn_stiffness_.size(); ++j) {
      const Joint& joint = garment_.joints[j];
      sewn_stiffness_[j] = static_cast<Real>(
          std::min({stiffest[joint.node], stiffest[joint.edge_first], stiffest[joint.edge_second]}));
    }
    for (const GarmentPanel& panel : garment_.panels)
      bodies_.insert(bodies_.end(), panel.nodes(), garment_.body_met_by(panel));
  }

  int threads() const override { return threads_; }

  void step(int count) override {
    for (int step = 0; step < count; ++step) {
      const auto phase = phase_rule<Real>(system_, rules_, seaming_.progress.draping);
      const Vector gravity{0, -phase.gravity, 0};
      const double time_s = static_cast<double>(seaming_.steps) * dt_s_;
      for_each_of(spring_order_, [&](std::size_t i) { add_spring_force(springs_[i]); });
      for_each(nodes_.size(), [&](std::size_t i) { add_external_forces(i, phase.damping, gravity); });
      for_each_of(joint_order_, [&](std::size_t i) { add_joint_force(joint_order_.things[i], time_s); });
      for_each(nodes_.size(), [&](std::size_t i) { update_velocity(i, phase.friction); });
      if (rules_.correction != VelocityCorrection::none)
        for_each_of(spring_order_, [&](std::size_t i) { correct(springs_[i]); });
      for_each(nodes_.size(), [&](std::size_t i) { move(i); });
      seaming_.end_step(rules_, dt_s_);
    }
  }

 private:
  using Base = ListDressing<Vector>;
  using Base::system_, Base::garment_, Base::rules_, Base::dt_, Base::dt_s_, Base::nodes_, Base::force_,
      Base::inverse_mass_, Base::seaming_;
  using typename Base::Node, typename Base::Real;
  struct ListedSpring {
    std::uint32_t first, second;
    LinearSpring<Real> law;
    Real limit;  ///< m, length above which it is over-elongated
  };

  template <class Act>
  void for_each(std::size_t count, const Act& act) {
    if constexpr (parallel) {
#pragma omp parallel for schedule(static) num_threads(threads_)
      for (std::size_t i = 0; i < count; ++i) act(i);
    } else {
      for (std::size_t i = 0; i < count; ++i) act(i);
    }
  }

  template <class Act>
  void for_each_of(const ThreadSafeOrder& order, const Act& act) {
    for (std::size_t round = 0; round + 1 < order.rounds.size(); ++round) {
      const std::size_t first = order.rounds[round];
      for_each(order.rounds[round + 1] - first, [&](std::size_t batch) {
        for (std::size_t i = order.batches[first + batch]; i < order.batches[first + batch + 1]; ++i) act(i);
      });
    }
  }

  void add_spring_force(const ListedSpring& spring) {  // loop 1
    const Vector d = nodes_[spring.second].x - nodes_[spring.first].x;
    const Vector force = spring_pull(dot(d, d), Real{0}, spring.law) * d;
    force_[spring.first] += force;
    force_[spring.second] -= force;
  }

  void add_external_forces(std::size_t i, Real damping, const Vector& gravity) {  // loop 2
    force_[i] += mass_[i] * (gravity - damping * nodes_[i].v);
  }

  void add_joint_force(std::size_t j, double time_s) {  // loop 3
    const Joint& joint = garment_.joints[j];
    const auto share = static_cast<Real>(joint.edge_share);
    const Vector& first = nodes_[joint.edge_first].x;
    const Vector gap = first + share * (nodes_[joint.edge_second].x - first) - nodes_[joint.node].x;
    const Real distance = square_root(dot(gap, gap));
    if (distance < static_cast<Real>(rules_.sewn_gap)) seaming_.sewn[j] = 1;
    const Real per_gap =
        seaming_.sewn[j] != 0
            ? sewn_stiffness_[j]
            : static_cast<Real>(seam_force(rules_.seam_force, time_s / rules_.seam_force_doubling_s,
                                           joint.length, joint.strength)) /
                  distance;
    const Vector force = per_gap * gap;
    force_[joint.node] += force;
    force_[joint.edge_first] -= (1 - share) * force;
    force_[joint.edge_second] -= share * force;
  }

  void update_velocity(std::size_t i, Real friction) {  // loop 4
    Node& node = nodes_[i];
    if (inverse_mass_[i] != 0) {
      node.v += dt_ * (inverse_mass_[i] * force_[i]);
      if (bodies_[i] != nullptr) meet(*bodies_[i], node, friction);
    }
    force_[i] = {};
  }

  /// The contact of kernels/body_contact.h without its push, in vector operations.
  void meet(const BodyMaps& body, Node& node, Real friction) const {
    const Vector at = node.x + dt_ * node.v;
    const Vec3<Real> point = at;
    const BodyPixel& pixel = body.pixel_at(point.x, point.y);
    const Vector front{pixel.front_x, pixel.front_y, pixel.front_z};
    const Vector back{pixel.back_x, pixel.back_y, pixel.back_z};
    const Real from_front = dot(front, at) - pixel.front_at, from_back = dot(back, at) - pixel.back_at;
    if (!(std::max(from_front, from_back) < 0)) return;
    const Vector& outwards = from_front < from_back ? back : front;
    const Real dropped = std::max(-dot(outwards, node.v), Real{0});
    const Vector along = node.v + dropped * outwards;
    node.v = floor_grip(dropped, dot(along, along), friction) * along;
  }

  void correct(const ListedSpring& spring) {  // loop 5
    Node &first = nodes_[spring.first], &second = nodes_[spring.second];
    const Vector d = second.x - first.x;
    const Real squared = dot(d, d);
    if (!(elongation_excess(squared, spring.limit) > 0)) return;
    const Real of_first = inverse_mass_[spring.first], of_second = inverse_mass_[spring.second];
    const Real impulse =
        elongation_impulse(squared, dot(second.v - first.v, d), spring.limit, Real{0}, of_first + of_second);
    first.v += (of_first * impulse) * d;
    second.v -= (of_second * impulse) * d;
  }

  void move(std::size_t i) {  // loop 6
    if (inverse_mass_[i] != 0) nodes_[i].x += dt_ * nodes_[i].v;
  }

  int threads_;
  ThreadSafeOrder spring_order_, joint_order_;
  std::vector<ListedSpring> springs_;    ///< in spring_order_
  std::vector<Real> mass_;               ///< [nodes] kg
  std::vector<const BodyMaps*> bodies_;  ///< [nodes] maps of the body for each
  std::vector<Real> sewn_stiffness_;     ///< [joints] N/m
};

template <class Vector, bool parallel>
std::unique_ptr<DressingBackend> make(const System& system, const Integrator& integrator, double dt_s,
                                      const ExecutionOptions& options) {
  require_semi_euler(integrator);
  return std::make_unique<PublishedLoops<Vector, parallel>>(system, dt_s, options.threads);
}

}  // namespace

MakePublishedDressing maker_of(const PublishedDressing& dressing) {
  if (dressing.simd) return dressing.parallel ? make<Vec3InRegister, true> : make<Vec3InRegister, false>;
  return dressing.parallel ? make<Vec3<float>, true> : make<Vec3<float>, false>;
}

std::unique_ptr<DressingBackend> make_published_reference(const System& system, const Integrator& integrator,
                                                          double dt_s) {
  return make<Vec3<double>, false>(system, integrator, dt_s, {});
}

}  // namespace mssim
