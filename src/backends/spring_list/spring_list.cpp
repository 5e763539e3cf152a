#include "backends/spring_list/spring_list.h"

#include <algorithm>

namespace mssim {

template <class Real>
SpringList<Real>::SpringList(const System& system, const Integrator& integrator, double dt_s)
    : system_(system),
      integrator_(integrator),
      coefficients_(coefficients_of<Real>(integrator, dt_s)),
      materials_(materials_of<Real>(system)),
      pinned_(system.nodes()),
      force_(system.nodes()) {
  inverse_mass_.reserve(system.nodes());
  for (const double mass : system.node_mass) inverse_mass_.push_back(static_cast<Real>(1 / mass));
  for (const std::uint32_t node : system.pins) pinned_[node] = 1;
  for (std::size_t pair = 0; pair < pair_kinds; ++pair)
    if (stores(integrator, static_cast<Pair>(pair), storage)) pairs_[pair].resize(system.nodes());
  set_state(system.start);
}

template <class Real>
void SpringList<Real>::set_state(const State& state) {
  for (std::size_t pair = 0; pair < pair_kinds; ++pair)
    place_[pair] = index(storage_of(integrator_, static_cast<Pair>(pair), storage));
  for (std::vector<Node>& nodes : pairs_)  // the trial pairs too: pinned nodes are never updated
    for (std::size_t i = 0; i < nodes.size(); ++i)
      nodes[i] = {vec3_cast<Real>(state.position[i]), vec3_cast<Real>(state.velocity[i])};
}

template <class Real>
State SpringList<Real>::state() const {
  State state;
  state.position.reserve(nodes());
  state.velocity.reserve(nodes());
  for (const Node& node : array(Pair::state)) {
    state.position.push_back(vec3_cast<double>(node.x));
    state.velocity.push_back(vec3_cast<double>(node.v));
  }
  return state;
}

template <class Real>
void SpringList<Real>::clear_forces(std::size_t first, std::size_t last) {
  std::fill(force_.begin() + static_cast<std::ptrdiff_t>(first),
            force_.begin() + static_cast<std::ptrdiff_t>(last), Vec3<Real>{});
}

template <class Real>
void SpringList<Real>::end_step() {
  if (swaps_state(integrator_, storage)) std::swap(place_[index(Pair::state)], place_[index(Pair::next)]);
}

template class SpringList<float>;
template class SpringList<double>;

}  // namespace mssim
