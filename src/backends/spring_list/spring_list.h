#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "integrators/coefficients.h"
#include "laws/host_laws.h"
#include "model/system.h"

namespace mssim {

#define MSSIM_INLINE [[gnu::always_inline]] inline
#define MSSIM_INLINE_LAMBDA __attribute__((always_inline))
#include "integrators/stage_update-inl.h"
#undef MSSIM_INLINE
#undef MSSIM_INLINE_LAMBDA

/// A mass-spring system as in a straightforward program: an array of nodes and a list of springs, each of
/// which adds its force to both ends. The parts of a step are member functions over ranges, so one or many
/// threads can run them; this code has no knowledge of threads.
template <class Real>
class SpringList {
 public:
  struct Node {
    Vec3<Real> x;  ///< m
    Vec3<Real> v;  ///< m/s
  };

  SpringList(const System& system, const Integrator& integrator, double dt_s)
      : system_(system),
        integrator_(integrator),
        coefficients_(coefficients_of<Real>(integrator, dt_s)),
        materials_(materials_of<Real>(system)),
        pinned_(system.nodes()),
        force_(system.nodes()) {
    inverse_mass_.reserve(system.nodes());
    for (const double mass : system.node_mass) inverse_mass_.push_back(static_cast<Real>(1 / mass));
    for (const std::uint32_t node : system.pins) pinned_[node] = 1;
    for (const Pair pair : stored_pairs(integrator, storage)) pairs_[index(pair)].resize(system.nodes());
    set_state(system.start);
  }

  void set_state(const State& state) {
    for (std::size_t pair = 0; pair < pair_kinds; ++pair)
      place_[pair] = index(storage_of(integrator_, static_cast<Pair>(pair), storage));
    for (std::vector<Node>& nodes : pairs_)  // including trial pairs: pinned nodes are never updated
      for (std::size_t i = 0; i < nodes.size(); ++i)
        nodes[i] = {vec3_cast<Real>(state.position[i]), vec3_cast<Real>(state.velocity[i])};
  }
  State state() const {
    State state;
    state.position.reserve(nodes());
    state.velocity.reserve(nodes());
    for (const Node& node : array(Pair::state))
      state.add(vec3_cast<double>(node.x), vec3_cast<double>(node.v));
    return state;
  }

  std::size_t nodes() const { return force_.size(); }
  std::span<const Spring> springs() const { return system_.springs; }

  void clear_forces(std::size_t first, std::size_t last) {
    std::fill(force_.data() + first, force_.data() + last, Vec3<Real>{});
  }
  /// Force of a spring on its first end, N; the second end gets the opposite.
  Vec3<Real> force_of(const Spring& spring, Pair gather) const {
    const Node& first = array(gather)[spring.first];
    const Node& second = array(gather)[spring.second];
    const Vec3<Real> d = second.x - first.x;
    return spring_pull(dot(d, d), dot(second.v - first.v, d),
                       linear_spring(materials_[spring.kind], static_cast<Real>(spring.rest_length))) *
           d;
  }
  void add_force(const Spring& spring, const Vec3<Real>& force) {
    force_[spring.first] += force;
    force_[spring.second] -= force;
  }
  /// The sum of forces on a node, N, for code that adds in another way.
  Vec3<Real>& force(std::size_t node) { return force_[node]; }
  /// Executes the stage's assignments for nodes first .. last - 1, once all forces are complete.
  template <std::size_t method, std::size_t stage>
  void update_nodes(std::size_t first, std::size_t last) {
    const std::vector<Node>& gathered = array(integrators[method].stages[stage].gather);
    std::array<Node*, pair_kinds> nodes;
    for (std::size_t pair = 0; pair < pair_kinds; ++pair) nodes[pair] = array(static_cast<Pair>(pair)).data();
    const Real viscous_damping = static_cast<Real>(system_.viscous_damping);
    const Real gravity = static_cast<Real>(system_.gravity);
    const Floor& floor = system_.floor;
    for (std::size_t i = first; i < last; ++i) {
      if (pinned_[i] != 0) continue;
      const Node node = gathered[i];
      const Vec3<Real> a = node_acceleration(inverse_mass_[i] * force_[i], node.v, viscous_damping, gravity);
      const auto slot_of = [&](auto slot) -> Vec3<Real>& {
        constexpr std::size_t s = index(decltype(slot)::value);
        return s % 2 == 0 ? nodes[s / 2][i].x : nodes[s / 2][i].v;
      };
      update_stage<method, stage>(
          coefficients_, node.x, node.v, a, slot_of,
          [&](auto slot, const Vec3<Real>& value) { slot_of(slot) = value; },
          [&](Vec3<Real>& x, Vec3<Real>& v) {
            touch_floor(x, v, static_cast<Real>(floor.height), static_cast<Real>(floor.restitution),
                        static_cast<Real>(floor.friction));
          });
    }
  }
  /// Ends a step: the last stage's result becomes the state, if it is not in the same array.
  void end_step() { std::swap(place_[index(Pair::state)], place_[index(Pair::next)]); }

 private:
  /// All forces of a stage are computed before a node is updated, so pairs may share arrays.
  static constexpr Storage storage = Storage::in_place;
  const std::vector<Node>& array(Pair pair) const { return pairs_[place_[index(pair)]]; }
  std::vector<Node>& array(Pair pair) { return pairs_[place_[index(pair)]]; }

  const System& system_;
  const Integrator& integrator_;
  Coefficients<Real> coefficients_;
  std::vector<SpringConstants<Real>> materials_;
  std::vector<std::uint8_t> pinned_;                 ///< [nodes]
  std::vector<Real> inverse_mass_;                   ///< [nodes] 1/kg
  std::vector<Vec3<Real>> force_;                    ///< [nodes] N
  std::array<std::vector<Node>, pair_kinds> pairs_;  ///< [nodes] each; empty if not stored
  std::array<std::size_t, pair_kinds> place_{};      ///< role -> element of pairs_
};

}  // namespace mssim
