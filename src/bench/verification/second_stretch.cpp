#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include "backends/backends.h"
#include "bench/verification/verification.h"
#include "text/text.h"

namespace mssim {

void add_block(SolidBlock& blocks, std::uint32_t nx, std::uint32_t ny, std::uint32_t nz, double spacing,
               const Vec3d& corner) {
  const auto first = static_cast<std::uint32_t>(blocks.position.size());
  for (std::uint32_t z = 0; z < nz; ++z)
    for (std::uint32_t y = 0; y < ny; ++y)
      for (std::uint32_t x = 0; x < nx; ++x)
        blocks.position.push_back(corner + Vec3d{x * spacing, y * spacing, z * spacing});
  const auto node = [&](std::array<std::uint32_t, 3> at) {
    return first + (at[2] * ny + at[1]) * nx + at[0];
  };
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (std::uint32_t z = 0; z + 1 < nz; ++z)
    for (std::uint32_t y = 0; y + 1 < ny; ++y)
      for (std::uint32_t x = 0; x + 1 < nx; ++x) {
        std::array<std::size_t, 3> axes{0, 1, 2};
        do {  // the six ways from the cube's first corner to its last along edges
          std::array<std::uint32_t, 3> at{x, y, z};
          Tetrahedron corners{node(at)};
          for (std::size_t i = 0; i < 3; ++i) {
            ++at[axes[i]];
            corners[i + 1] = node(at);
          }
          const bool even = axes[0] == 0 ? axes[1] == 1 : axes[0] == 1 ? axes[1] == 2 : axes[1] == 0;
          if (!even) std::swap(corners[1], corners[2]);
          blocks.tetrahedra.push_back(corners);
          for (std::size_t a = 0; a < 4; ++a)
            for (std::size_t b = a + 1; b < 4; ++b) edges.insert(std::minmax(corners[a], corners[b]));
        } while (std::next_permutation(axes.begin(), axes.end()));
      }
  blocks.edges.insert(blocks.edges.end(), edges.begin(), edges.end());
}

namespace {

constexpr int most_steps = 400;
constexpr int starts = 8;
constexpr std::size_t enough_landed = 10;

/// Angular frequency times dt up to which explicit steps are stable: 2 to 2.83, depending on the integrator.
constexpr double fastest_mode = 3;

System small_cloth(const System& scene, const GridPatch& grid) {
  System small = with_laws_of(scene);
  const GridPatch patch{13, 17, grid.spacing};
  small.topology = patch;
  small.springs = springs_of(patch);
  small.node_mass.assign(patch.nodes(), scene.node_mass.front());
  if (!scene.pins.empty()) small.pins = {patch.node(0, 0), patch.node(0, patch.columns - 1)};
  for (std::uint32_t row = 0; row < patch.rows; ++row)
    for (std::uint32_t column = 0; column < patch.columns; ++column)
      small.start.position.push_back({(column - 8.0) * patch.spacing, 0, (row - 6.0) * patch.spacing});
  return small;
}

/// Two blocks, with the masses of the lightest and of the heaviest node.
System small_bodies(const System& scene) {
  System small = with_laws_of(scene);
  const auto [lightest, heaviest] = std::ranges::minmax_element(scene.node_mass);
  const double spacing = 0.8 * mean_rest_length(scene);  // edges, diagonals: about 1.3 times it
  SolidBlock blocks;
  for (const double mass : {*lightest, *heaviest}) {
    const double x = small.node_mass.empty() ? -4 : 1;
    add_block(blocks, 4, 5, 6, spacing, {x * spacing, 0, -2.5 * spacing});
    small.node_mass.resize(blocks.position.size(), mass);
  }
  // One edge is the lowest part.
  for (const Vec3d& at : blocks.position)
    small.start.position.push_back({at.x, 0.96 * at.y + 0.28 * at.z, 0.96 * at.z - 0.28 * at.y});
  const std::size_t of_first = blocks.position.size() / 2;
  for (const auto& [first, second] : blocks.edges)
    small.springs.push_back({first, second,
                             static_cast<float>(length(blocks.position[second] - blocks.position[first])),
                             (first < of_first ? scene.springs.front() : scene.springs.back()).kind});
  small.topology = TetrahedralMesh{std::move(blocks.tetrahedra)};
  return small;
}

/// Strains the system, lets it fall and slide, and puts the floor where its lowest nodes meet it after a
/// quarter of `seconds`.
void set_going(System& system, double seconds, int number) {
  constexpr double strain = 0.01, impact = 0.01;  // impact: strain that it makes
  const double unit = mean_rest_length(system);
  const double speed = impact * unit * std::sqrt(spectrum_at(system, system.start).stiffness);
  const double k = 2 * std::numbers::pi / (6 * unit);
  const double phase = 0.7 * number, drop = speed * seconds / 2;
  const auto wave = [&](double a, double b, double c) {
    return Vec3d{std::sin(k * a + phase), std::sin(k * b + 2 * phase), std::sin(k * c + 3 * phase)};
  };
  double low = 0, high = 0;  // along z
  for (const Vec3d& x : system.start.position) {
    low = std::min(low, x.z);
    high = std::max(high, x.z);
  }
  for (Vec3d& x : system.start.position) {
    const Vec3d at = x;
    system.start.velocity.push_back(speed * (Vec3d{0.7, -1, 0.4} + 0.5 * wave(at.z, at.x, at.x + at.z)));
    x += strain * unit * wave(at.y + at.z, at.x + at.z, at.x - at.y);
    x.y += drop * (high - at.z) / std::max(high - low, unit);
  }
  for (const std::uint32_t pin : system.pins) system.start.velocity[pin] = {};
  double lowest = system.start.position.front().y;
  for (const Vec3d& x : system.start.position) lowest = std::min(lowest, x.y);
  const double until = seconds / 4;
  system.floor.height = lowest - until * (speed + system.gravity * until / 2);
  const double raised = unit - system.floor.height;  // near the origin, but not in it
  for (Vec3d& x : system.start.position) x.y += raised;
  system.floor.height += raised;
  round_start_to_single(system);
}

/// Runs the reference for as long as results can be compared, at most `most` steps.
SecondStretch follow(System system, const Integrator& integrator, double dt_s, int most) {
  SecondStretch stretch{.system = std::move(system), .state = {}};
  const System& small = stretch.system;
  const System floorless = without_floor(small);
  const auto reference = make_reference(small, integrator, dt_s),
             rounded = make_reference(small, integrator, dt_s),
             falling = make_reference(floorless, integrator, dt_s);
  const double unit = mean_rest_length(small), ahead_s = integrator.ahead * dt_s;
  std::vector<std::uint8_t> has_landed(small.nodes(), 0);
  State state = small.start;
  for (int steps = 1; steps <= most; ++steps) {
    falling->set_state(state);
    falling->step(1);
    reference->step(1);
    const State before_floor = falling->state();
    const double tolerance = position_tolerance(small, integrator, steps);
    const double clear = tolerance / 4 * unit;
    bool decided = true;
    for (std::size_t i = 0; i < small.nodes(); ++i) {
      if (std::ranges::binary_search(small.pins, static_cast<std::uint32_t>(i))) continue;
      const double above =
          before_floor.position[i].y + ahead_s * before_floor.velocity[i].y - small.floor.height;
      decided = decided && std::abs(above) > clear;
      if (above < 0) has_landed[i] = 1;
    }
    state = reference->state();
    const State other = step_rounded(*rounded, ahead_s, 1);
    if (!decided || first_bad_node(state)) break;
    // A correct backend reached 1.8 times the rounded reference's deviation (cloths, semi-euler).
    constexpr double margin = 4;
    if (!(margin * position_roundings(integrator) * position_deviation(small, state, other) <= tolerance))
      continue;
    stretch.steps = steps;
    stretch.state = state;
    stretch.tolerance = tolerance;
    stretch.velocity_tolerance = fastest_mode * tolerance * unit / dt_s;
    stretch.landed = static_cast<std::size_t>(std::ranges::count(has_landed, 1));
  }
  return stretch;
}

}  // namespace

SecondStretch run_second_stretch(const System& scene, const Integrator& integrator, double dt_s) {
  const auto* grid = std::get_if<GridPatch>(&scene.topology);
  const System small = grid != nullptr ? small_cloth(scene, *grid) : small_bodies(scene);
  const int most = comparable_steps(small, integrator, dt_s, most_steps);
  SecondStretch best;
  const auto is_enough = [&] { return 2 * best.steps >= most && best.landed >= enough_landed; };
  for (int number = 0; number < starts && !is_enough(); ++number) {
    System system = small;
    set_going(system, most * dt_s, number);
    SecondStretch stretch = follow(std::move(system), integrator, dt_s, most);
    if (number == 0 || stretch.steps > best.steps) best = std::move(stretch);
  }
  best.most_steps = most;
  return best;
}

std::optional<std::string> verify_second(Backend& backend, const SecondStretch& stretch) {
  if (stretch.steps == 0) return std::nullopt;
  backend.step(stretch.steps);
  const State state = backend.state();
  const std::string after = fmt::format(" after {} of a small scene of its kind that meets the floor",
                                        pluralize(stretch.steps, "step"));
  if (first_bad_node(state)) return "not finite" + after;
  const double error = position_deviation(stretch.system, stretch.state, state);
  if (!(error <= stretch.tolerance))
    return fmt::format("position error {:.6g} of a rest length exceeds {:.6g}{}", error, stretch.tolerance,
                       after);
  double velocity_error = 0;
  for (std::size_t i = 0; i < state.velocity.size(); ++i)
    velocity_error = std::max(velocity_error, length(state.velocity[i] - stretch.state.velocity[i]));
  if (!(velocity_error <= stretch.velocity_tolerance))
    return fmt::format("velocity error {:.6g} m/s exceeds {:.6g} m/s{}", velocity_error,
                       stretch.velocity_tolerance, after);
  return std::nullopt;
}

}  // namespace mssim
