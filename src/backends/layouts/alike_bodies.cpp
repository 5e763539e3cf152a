#include "backends/layouts/alike_bodies.h"

#include <algorithm>
#include <utility>

#include "backends/layouts/node_arrays.h"
#include "backends/layouts/spring_graph.h"

namespace mssim {

template <class Real>
std::optional<std::vector<AlikeBodiesOf<Real>>> find_alike_bodies(const System& system) {
  const std::vector<std::uint32_t> order = reverse_cuthill_mckee(system.nodes(), system.springs);
  const std::vector<std::uint32_t> place = places_in(order);
  const SpringsByFirstEnd springs(system.springs, place, place);
  std::vector<std::uint8_t> pinned(system.nodes(), 0);
  for (const std::uint32_t node : system.pins) pinned[node] = 1;

  std::vector<AlikeBodiesOf<Real>> all;
  std::size_t begin = 0;
  for (const std::size_t end : component_ends(system.springs, place)) {
    AlikeBodiesOf<Real> body;
    body.bodies.emplace_back(order.begin() + static_cast<std::ptrdiff_t>(begin),
                             order.begin() + static_cast<std::ptrdiff_t>(end));
    const double mass = system.node_mass[order[begin]];
    std::optional<std::uint32_t> kind;
    for (std::size_t at = begin; at < end; ++at) {
      if (system.node_mass[order[at]] != mass) return std::nullopt;
      body.pinned.push_back(pinned[order[at]]);
      body.first_spring.push_back(static_cast<std::uint32_t>(body.springs.size()));
      const std::size_t first = body.springs.size();
      for (const std::uint32_t number : springs.at(at)) {
        const Spring& spring = system.springs[number];
        if (spring.kind != kind.value_or(spring.kind)) return std::nullopt;
        kind = spring.kind;
        const SpringPerMassOf<Real> law = spring_per_mass<Real>(
            system.materials[spring.kind], static_cast<double>(spring.rest_length), mass);
        body.constants = law.constants;
        body.springs.push_back(
            {springs.second_slot(spring) - static_cast<std::uint32_t>(begin), law.stiffness_rest});
      }
      std::ranges::sort(body.springs.begin() + static_cast<std::ptrdiff_t>(first), body.springs.end(), {},
                        &AlikeBodiesOf<Real>::SpringAhead::other);
    }
    body.first_spring.push_back(static_cast<std::uint32_t>(body.springs.size()));
    begin = end;
    const auto known = std::ranges::find_if(all, [&](const AlikeBodiesOf<Real>& of) {
      return of.constants == body.constants && of.pinned == body.pinned &&
             of.first_spring == body.first_spring && of.springs == body.springs;
    });
    if (known == all.end())
      all.push_back(std::move(body));
    else
      known->bodies.push_back(std::move(body.bodies.front()));
  }
  return all;
}

template <class Real>
std::size_t spring_vectors(const std::vector<AlikeBodiesOf<Real>>& bodies, std::size_t lanes) {
  std::size_t vectors = 0;
  for (const AlikeBodiesOf<Real>& of : bodies)
    vectors += (of.bodies.size() + lanes - 1) / lanes * of.springs.size();
  return vectors;
}

template <class Real>
std::optional<std::vector<AlikeBodiesOf<Real>>> alike_bodies_for(const System& system, std::size_t lanes,
                                                                 double per_body) {
  auto bodies = find_alike_bodies<Real>(system);
  if (bodies && static_cast<double>(lanes * spring_vectors(*bodies, lanes)) >
                    per_body * static_cast<double>(system.springs.size()))
    bodies.reset();
  return bodies;
}

template <class Real>
AlikeSlices::AlikeSlices(const std::vector<AlikeBodiesOf<Real>>& bodies, std::size_t lane_count)
    : lanes(lane_count) {
  for (std::size_t shape = 0; shape < bodies.size(); ++shape) {
    const std::vector<std::vector<std::uint32_t>>& all = bodies[shape].bodies;
    nodes += all.size() * bodies[shape].nodes();
    for (std::size_t first = 0; first < all.size(); first += lanes) {
      groups.push_back({shape, count});
      count += bodies[shape].nodes();
      for (std::size_t node = 0; node < bodies[shape].nodes(); ++node)
        for (std::size_t lane = 0; lane < lanes; ++lane)
          scene_node.push_back(all[first + lane < all.size() ? first + lane : first][node]);
    }
  }
}

template <class Real>
void AlikeSlices::write(const State& state, Real* pair) const {
  for (std::size_t slot = 0; slot < scene_node.size(); ++slot) {
    Real* const x = pair + slot_offset(slot, components, lanes);
    write_vector(x, lanes, state.position[scene_node[slot]]);
    write_vector(x + 3 * lanes, lanes, state.velocity[scene_node[slot]]);
  }
}

template <class Real>
State AlikeSlices::read(const Real* pair) const {
  State state{std::vector<Vec3d>(nodes), std::vector<Vec3d>(nodes)};
  for (std::size_t slot = 0; slot < scene_node.size(); ++slot) {
    const Real* const x = pair + slot_offset(slot, components, lanes);
    state.position[scene_node[slot]] = read_vector(x, lanes);
    state.velocity[scene_node[slot]] = read_vector(x + 3 * lanes, lanes);
  }
  return state;
}

// NOLINTBEGIN(bugprone-macro-parentheses): a type has no parentheses
#define MSSIM_INSTANTIATE(Real)                                                                         \
  template std::optional<std::vector<AlikeBodiesOf<Real>>> find_alike_bodies(const System&);            \
  template std::size_t spring_vectors(const std::vector<AlikeBodiesOf<Real>>&, std::size_t);            \
  template std::optional<std::vector<AlikeBodiesOf<Real>>> alike_bodies_for(const System&, std::size_t, \
                                                                            double);                    \
  template AlikeSlices::AlikeSlices(const std::vector<AlikeBodiesOf<Real>>&, std::size_t);              \
  template void AlikeSlices::write(const State&, Real*) const;                                          \
  template State AlikeSlices::read(const Real*) const;
MSSIM_INSTANTIATE(float)
MSSIM_INSTANTIATE(double)
#undef MSSIM_INSTANTIATE
// NOLINTEND(bugprone-macro-parentheses)

}  // namespace mssim
