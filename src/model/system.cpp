#include "model/system.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <random>
#include <string>

#include "text/text.h"

namespace mssim {
namespace {

void append(std::string& bytes, std::uint64_t word) {
  for (int shift = 0; shift < 64; shift += 8) bytes += static_cast<char>(word >> shift & 255U);
}

void append(std::string& bytes, const Vec3d& vector) {
  for (const double number : {vector.x, vector.y, vector.z})
    append(bytes, std::bit_cast<std::uint64_t>(number));
}

/// Linearised response of a spring to displacements of its ends, in a state.
struct LinearisedSpring {
  std::uint32_t first, second;
  Vec3d direction;
  double along, across;
};

/// The springs' part of K, or of C, at the state.
std::vector<LinearisedSpring> linearised_springs(const System& system, const State& state, bool damping) {
  std::vector<LinearisedSpring> springs;
  springs.reserve(system.springs.size());
  for (const Spring& spring : system.springs) {
    const Vec3d d = state.position[spring.second] - state.position[spring.first];
    const double inverse_length = 1 / length(d);
    const auto law = linear_spring(system.materials[spring.kind], static_cast<double>(spring.rest_length));
    springs.push_back({spring.first, spring.second, inverse_length * d,
                       damping ? spring_damping_along(law.constants) : spring_along(law),
                       damping ? 0 : spring_across(inverse_length, law)});
  }
  return springs;
}

/// The Rayleigh quotient to which power iteration with these springs converges (spectrum_at).
double spectral_radius_of(const System& system, const std::vector<LinearisedSpring>& springs) {
  constexpr int stride = 100, most = 3000;
  std::mt19937 random(19580101);  // any fixed seed: the same vector each time, with one standard library
  std::uniform_real_distribution<double> component(-1, 1);
  std::vector<Vec3d> vector(system.nodes()), force(system.nodes());
  for (Vec3d& x : vector) x = {component(random), component(random), component(random)};
  for (const std::uint32_t node : system.pins) vector[node] = {};
  const auto scale = [&] {
    double sum = 0;
    for (std::size_t i = 0; i < vector.size(); ++i) sum += system.node_mass[i] * dot(vector[i], vector[i]);
    if (!(sum > 0)) return;
    const double factor = 1 / std::sqrt(sum);
    for (Vec3d& x : vector) x = factor * x;
  };
  scale();
  double before = 0, quotient = 0;
  for (int done = 1; done <= most; ++done) {
    for (Vec3d& of_node : force) of_node = {};
    for (const LinearisedSpring& spring : springs) {
      const Vec3d pull = spring_jacobian_times(spring.direction, spring.along, spring.across,
                                               vector[spring.second] - vector[spring.first]);
      force[spring.first] -= pull;
      force[spring.second] += pull;
    }
    for (const std::uint32_t node : system.pins) force[node] = {};
    quotient = 0;
    for (std::size_t i = 0; i < vector.size(); ++i) {
      quotient += dot(vector[i], force[i]);
      vector[i] = (1 / system.node_mass[i]) * force[i];
    }
    scale();
    if (done % stride != 0) continue;
    if (!(std::abs(quotient - before) > 1e-3 * std::abs(quotient))) break;
    before = quotient;
  }
  return quotient;
}

}  // namespace

float GridPatch::rest_length(GridSpringKind kind) const {
  return static_cast<float>(spacing * std::sqrt(grid_spring_kinds[kind].length_squared));
}

std::uint64_t count_springs(std::uint64_t rows, std::uint64_t columns) {
  std::uint64_t count = 0;
  for (const GridSpring& spring : grid_stencil) {
    const auto down = static_cast<std::uint64_t>(spring.rows < 0 ? -spring.rows : spring.rows);
    const auto right = static_cast<std::uint64_t>(spring.columns);
    if (rows > down && columns > right) count += (rows - down) * (columns - right);
  }
  return count;
}

std::vector<Spring> springs_of(const GridPatch& grid) {
  std::vector<Spring> springs;
  springs.reserve(count_springs(grid.rows, grid.columns));
  std::array<float, grid_spring_kinds.size()> rest_length{};
  for (const GridSpringKind kind : {structural, shear, bending}) rest_length[kind] = grid.rest_length(kind);
  const std::int64_t rows = grid.rows, columns = grid.columns;
  for (std::int64_t row = 0; row < rows; ++row)
    for (std::int64_t column = 0; column < columns; ++column)
      for (const GridSpring& spring : grid_stencil) {
        const std::int64_t other_row = row + spring.rows, other_column = column + spring.columns;
        if (other_row < 0 || other_row >= rows || other_column >= columns) continue;
        springs.push_back({static_cast<std::uint32_t>(row * columns + column),
                           static_cast<std::uint32_t>(other_row * columns + other_column),
                           rest_length[spring.kind], spring.kind});
      }
  return springs;
}

std::optional<double> uniform_node_mass(const System& system) {
  const std::vector<double>& mass = system.node_mass;
  if (mass.empty() || std::adjacent_find(mass.begin(), mass.end(), std::not_equal_to<>()) != mass.end())
    return std::nullopt;
  return mass.front();
}

double mean_rest_length(const System& system) {
  if (system.springs.empty()) return 1;
  double sum = 0;
  for (const Spring& spring : system.springs) sum += spring.rest_length;
  return sum / static_cast<double>(system.springs.size());
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
  // Through memory: if g++ 12.2 vectorises a conversion to float and back to double, at -O2 and -O3, it
  // leaves the doubles unchanged.
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

namespace {

/// Of the springs for which `counts` is true.
template <class Counts>
ModeBound::Part bound_of_springs(const System& system, Counts counts) {
  std::vector<ModeBound::Part> node(system.nodes());  // N/m, N s/m
  for (const Spring& spring : system.springs) {
    if (!counts(spring)) continue;
    const auto law = linear_spring(system.materials[spring.kind], static_cast<double>(spring.rest_length));
    for (const std::uint32_t end : {spring.first, spring.second}) {
      node[end].stiffness += spring_along(law);
      node[end].damping += spring_damping_along(law.constants);
    }
  }
  ModeBound::Part bound;
  for (std::size_t i = 0; i < node.size(); ++i) {
    bound.stiffness = std::max(bound.stiffness, 2 * node[i].stiffness / system.node_mass[i]);
    bound.damping = std::max(bound.damping, 2 * node[i].damping / system.node_mass[i]);
  }
  return bound;
}

}  // namespace

ModeBound mode_bound(const System& system) {
  const auto [stiffness, damping] = bound_of_springs(system, [](const Spring& /*spring*/) { return true; });
  ModeBound bound{stiffness, damping + system.viscous_damping, system.viscous_damping};
  constexpr double rounding = 1e-9;
  const auto damps_as_all = [&](const SpringMaterial& a) {
    return std::ranges::all_of(system.materials, [&](const SpringMaterial& b) {
      const double one = a.damping * b.stiffness, other = b.damping * a.stiffness;
      return std::abs(one - other) <= rounding * std::max(one, other);
    });
  };
  if (std::ranges::all_of(system.materials, damps_as_all)) return bound;
  for (std::size_t kind = 0; kind < system.materials.size(); ++kind)
    bound.parts.push_back(
        bound_of_springs(system, [&](const Spring& spring) { return spring.kind == kind; }));
  return bound;
}

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

Spectrum spectrum_at(const System& system, const State& state) {
  return {spectral_radius_of(system, linearised_springs(system, state, false)),
          spectral_radius_of(system, linearised_springs(system, state, true)) + system.viscous_damping};
}

Energy energy_of(const System& system, const State& state) {
  Energy energy;
  for (std::size_t i = 0; i < system.nodes(); ++i) {
    const double mass = system.node_mass[i];
    energy.kinetic += 0.5 * mass * dot(state.velocity[i], state.velocity[i]);
    energy.gravitational += mass * system.gravity * (state.position[i].y - system.floor.height);
  }
  for (const Spring& spring : system.springs) energy.elastic += elastic_energy(system, spring, state);
  return energy;
}

std::string_view energies_leave_out(const System& system) {
  if (!std::holds_alternative<Garment>(system.topology)) return "";
  return "the work of seams, of contacts and of the correction of elongations; and gravitational energy "
         "counts in full even while seams close, when gravity may be reduced";
}

double elastic_energy(const System& system, const Spring& spring, const State& state) {
  const Vec3d d = state.position[spring.second] - state.position[spring.first];
  return spring_energy(length(d), static_cast<double>(spring.rest_length), system.materials[spring.kind]);
}

double damping_power(const System& system, const State& state) {
  double power = 0;
  for (std::size_t i = 0; i < system.nodes(); ++i)
    power += system.viscous_damping * system.node_mass[i] * dot(state.velocity[i], state.velocity[i]);
  for (const Spring& spring : system.springs) {
    const Vec3d d = state.position[spring.second] - state.position[spring.first];
    const double closing = dot(state.velocity[spring.second] - state.velocity[spring.first], d);
    power += spring_loss(dot(d, d), closing, system.materials[spring.kind]);
  }
  return power;
}

}  // namespace mssim
