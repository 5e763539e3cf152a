#include "ranks/bodies_part.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace mssim {
namespace {

/// A node and the rank that it matters to.
using RankAndNode = std::pair<int, std::uint32_t>;

/// Sorted, each once.
std::vector<RankAndNode> in_order(std::vector<RankAndNode> nodes) {
  std::ranges::sort(nodes);
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

}  // namespace

BodiesPart part_of_bodies(const System& bodies, std::span<const std::uint32_t> place,
                          std::span<const int> owner, int rank) {
  std::vector<RankAndNode> edge, ghosts;
  for (const Spring& spring : bodies.springs)
    for (const auto& [node, other] : {std::pair{spring.first, spring.second}, {spring.second, spring.first}})
      if (owner[node] == rank && owner[other] != rank) {
        edge.emplace_back(owner[other], node);
        ghosts.emplace_back(owner[other], other);
      }
  edge = in_order(std::move(edge));
  ghosts = in_order(std::move(ghosts));

  constexpr std::uint32_t elsewhere = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> number(bodies.nodes(), elsewhere);  // in the part
  BodiesPart part;
  System& system = part.system;
  const auto add = [&](std::uint32_t node) {
    number[node] = static_cast<std::uint32_t>(system.nodes());
    system.start.position.push_back(bodies.start.position[node]);
    system.start.velocity.push_back(bodies.start.velocity[node]);
    system.node_mass.push_back(bodies.node_mass[node]);
    part.graph.place.push_back(place[node]);
  };
  for (std::uint32_t node = 0; node < bodies.nodes(); ++node)
    if (owner[node] == rank) add(node);
  part.graph.own = system.nodes();
  for (const auto& [other_rank, node] : ghosts) {
    add(node);
    if (part.neighbours.empty() || part.neighbours.back().rank != other_rank)
      part.neighbours.push_back({other_rank, {}, 0});
    ++part.neighbours.back().ghosts;
  }
  // A rank that has a ghost here has one of its own nodes beside it.
  auto neighbour = part.neighbours.begin();
  for (const auto& [other_rank, node] : edge) {
    while (neighbour->rank != other_rank) ++neighbour;
    neighbour->edge.push_back(number[node]);
  }
  for (Spring spring : bodies.springs) {
    if (owner[spring.first] != rank && owner[spring.second] != rank) continue;
    spring.first = number[spring.first];
    spring.second = number[spring.second];
    system.springs.push_back(spring);
  }
  for (const std::uint32_t pin : bodies.pins)
    if (owner[pin] == rank) system.pins.push_back(number[pin]);
  system.materials = bodies.materials;
  system.gravity = bodies.gravity;
  system.viscous_damping = bodies.viscous_damping;
  system.floor = bodies.floor;
  system.solver = bodies.solver;
  return part;
}

}  // namespace mssim
