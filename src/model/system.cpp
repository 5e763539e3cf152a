#include "model/system.h"

#include <algorithm>
#include <array>
#include <bit>
#include <functional>
#include <limits>
#include <string>

#include "text/text.h"

namespace mssim {

std::optional<double> uniform_node_mass(const System& system) {
  const std::vector<double>& mass = system.node_mass;
  if (mass.empty() || std::adjacent_find(mass.begin(), mass.end(), std::not_equal_to<>()) != mass.end())
    return std::nullopt;
  return mass.front();
}

double mean_rest_length(const System& system) {
  double sum = 0;
  for (const Spring& spring : system.springs) sum += spring.rest_length;
  return system.springs.empty() ? 0 : sum / static_cast<double>(system.springs.size());
}

System with_laws_of(const System& system) {
  System other;
  other.materials = system.materials;
  other.gravity = system.gravity;
  other.viscous_damping = system.viscous_damping;
  other.floor = system.floor;
  other.solver = system.solver;
  return other;
}

System without_floor(System system) {
  system.floor.height = std::numeric_limits<double>::lowest();
  return system;
}

void round_to_single(double& value) {
  // Through memory: g++ 12 vectorises a conversion to float and back to double into nothing at all (-O2, no
  // fast-math).
  const volatile float single = static_cast<float>(value);
  value = static_cast<double>(single);
}

void round_to_single(State& state) {
  for (std::vector<Vec3d>* vectors : {&state.position, &state.velocity})
    for (Vec3d& vector : *vectors) {
      round_to_single(vector.x);
      round_to_single(vector.y);
      round_to_single(vector.z);
    }
}

void round_start_to_single(System& system) {
  round_to_single(system.start);
  round_to_single(system.floor.height);
}

StiffnessBound stiffness_bound(const System& system) {
  struct Sum {
    double stiffness = 0, damping = 0;
  };
  std::vector<Sum> node(system.nodes());
  for (const Spring& spring : system.springs) {
    const SpringMaterial& material = system.materials[spring.kind];
    for (const std::uint32_t end : {spring.first, spring.second}) {
      node[end].stiffness += material.stiffness;
      node[end].damping += material.damping;
    }
  }
  StiffnessBound bound;
  for (std::size_t i = 0; i < node.size(); ++i) {
    bound.stiffness = std::max(bound.stiffness, 2 * node[i].stiffness / system.node_mass[i]);
    bound.damping = std::max(bound.damping, 2 * node[i].damping / system.node_mass[i]);
  }
  bound.damping += system.viscous_damping;
  return bound;
}

namespace {

void append(std::string& bytes, std::uint64_t word) {
  for (int shift = 0; shift < 64; shift += 8) bytes += static_cast<char>(word >> shift & 255U);
}

void append(std::string& bytes, const Vec3d& vector) {
  for (const double number : {vector.x, vector.y, vector.z})
    append(bytes, std::bit_cast<std::uint64_t>(number));
}

}  // namespace

std::uint64_t state_hash(const State& state) {
  std::string hashes, leaf;
  const std::size_t nodes = state.position.size();
  for (std::size_t first = 0; first < nodes; first += state_hash_leaf) {
    leaf.clear();
    for (std::size_t i = first; i < std::min(nodes, first + state_hash_leaf); ++i) {
      append(leaf, state.position[i]);
      append(leaf, state.velocity[i]);
    }
    append(hashes, fnv1a_64(leaf));
  }
  return fnv1a_64(hashes);
}

}  // namespace mssim
