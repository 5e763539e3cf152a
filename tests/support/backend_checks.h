#pragma once

#include <type_traits>

#include "backends/backends.h"
#include "backends/interface/backend.h"
#include "bench/verification/verification.h"
#include "tests/support/systems.h"
#include "tests/support/testing.h"

namespace mssim {

/// Names the cases of a test by their parameter, the name of an integrator, say, or by the two of a tuple.
struct ByName {
  static std::string of(std::string_view first, std::string_view second = "") {
    std::string name(first);
    if (!second.empty()) name.append("__").append(second);
    std::ranges::replace_if(
        name, [](char c) { return c == '-' || c == ':'; }, '_');
    return name;
  }
  template <class Parameter>
  std::string operator()(const testing::TestParamInfo<Parameter>& test) const {
    if constexpr (std::is_convertible_v<Parameter, std::string_view>)
      return of(test.param);
    else
      return of(std::get<0>(test.param), std::get<1>(test.param));
  }
};

/// Of the rows of a table, such as integrators.
std::vector<std::string_view> names_of(const auto& table) {
  std::vector<std::string_view> names;
  for (const auto& row : table) names.push_back(row.name);
  return names;
}

/// A backend of the table, also as NAME:double.
inline BackendInfo row_named(std::string_view name) {
  const std::string_view suffix = ":double";
  BackendInfo row = *find_backend(name.substr(0, name.find(':')));
  row.name = name;
  row.in_double = name.ends_with(suffix);
  return row;
}
/// What makes its backends for explicit integrators.
inline auto maker_of(const BackendInfo& row) { return row.in_double ? row.make_in_double : row.make; }

/// The state of a backend after further steps.
inline State state_after(Backend& backend, int steps) {
  backend.step(steps);
  return backend.state();
}

/// How far the nodes of two backends are from each other, at most, after as many further steps of both, m.
inline double distance_after(int steps, Backend& one, Backend& other) {
  const State first = state_after(one, steps);
  return largest_distance(first.position, state_after(other, steps).position);
}

/// Whether positions and velocities are the same to the last bit; else says where they are not.
inline testing::AssertionResult same_state(const State& found, const State& expected) {
  if (found.position.size() != expected.position.size() || found.velocity.size() != expected.velocity.size())
    return testing::AssertionFailure() << found.position.size() << " nodes, not " << expected.position.size();
  for (std::size_t node = 0; node < found.position.size(); ++node)
    if (found.position[node] != expected.position[node] || found.velocity[node] != expected.velocity[node])
      return testing::AssertionFailure() << "node " << node << " differs";
  return testing::AssertionSuccess();
}

/// Whether pinned nodes are exactly where they began, and do not move.
inline testing::AssertionResult pins_hold(const System& system, const State& state) {
  for (const std::uint32_t pin : system.pins)
    if (state.position[pin] != system.start.position[pin] || state.velocity[pin] != Vec3d{})
      return testing::AssertionFailure() << "pin " << pin << " has moved";
  return testing::AssertionSuccess();
}

/// Whether the backend passes the verification of a bench.
inline testing::AssertionResult agrees(Backend& backend, const System& system, const Reference& reference,
                                       double dt_s) {
  if (reference.failure) return testing::AssertionFailure() << "the reference: " << *reference.failure;
  if (reference.steps != verification_steps)
    return testing::AssertionFailure() << "the reference takes " << reference.steps << " steps";
  const Verification verification = verify(backend, system, reference, dt_s);
  if (!verification.failure) return testing::AssertionSuccess();
  return testing::AssertionFailure() << system.nodes() << " nodes: " << *verification.failure;
}
inline testing::AssertionResult agrees(Backend& backend, const System& system, const Integrator& integrator,
                                       double dt_s) {
  return agrees(backend, system, run_reference(system, integrator, dt_s), dt_s);
}

/// Expects no more than twice the distance from the reference that the plain list in single precision has: no
/// formula or order of sums gives accuracy up.
inline void expect_as_near_as_the_spring_list(Backend& backend, const System& system,
                                              const Integrator& integrator, double dt_s) {
  const Reference reference = run_reference(system, integrator, dt_s);
  const auto distance = [&](Backend& of) {
    return verify(of, system, reference, dt_s).position_error.value();
  };
  const double usual = distance(*find_backend("serial")->make(system, integrator, dt_s, {1, ""}));
  EXPECT_GT(usual, 0);
  EXPECT_LE(distance(backend), 2 * usual) << integrator.name << ", " << system.nodes() << " nodes";
}

/// A sheet that is about to hit the floor flat, sliding: its nodes land in the same step in any precision.
inline System sliding_sheet(std::uint32_t rows, std::uint32_t columns) {
  System system = build_system(sheet_spec(rows, columns, 0.00101));
  for (Vec3d& v : system.start.velocity) v = {0.5, -1, 0.25};
  return system;
}

/// Expects that what begins like sliding_sheet() bounces and slides in both alike; node 0 lands.
inline void expect_same_bounce(Backend& backend, Backend& reference, int steps) {
  reference.step(steps);
  backend.step(steps);
  const State expected = reference.state(), found = backend.state();
  EXPECT_GT(expected.velocity[0].y, 0.2) << "it has bounced";
  EXPECT_LT(expected.velocity[0].x, 0.45) << "friction has slowed it";
  EXPECT_LE(largest_distance(found.velocity, expected.velocity), 2e-3);
  EXPECT_LE(largest_distance(found.position, expected.position), 1e-6);
}

/// Expects that a backend has taken a state of single precision to the bit. Of openmp's cloths, whose unit of
/// time is a step, velocities are rounded once more; what these give back themselves they take to the bit.
inline void expect_has_taken(Backend& backend, const State& given) {
  const State taken = backend.state();
  const bool in_steps = backend.device().starts_with("cpu ") && backend.steps_per_pass() > 0;
  if (!in_steps) {
    EXPECT_TRUE(same_state(taken, given));
    return;
  }
  ASSERT_EQ(taken.velocity.size(), given.velocity.size());
  EXPECT_EQ(largest_distance(taken.position, given.position), 0);
  for (std::size_t node = 0; node < given.velocity.size(); ++node)
    EXPECT_LE(length(taken.velocity[node] - given.velocity[node]), 0x1p-24 * length(given.velocity[node]))
        << node;
  backend.set_state(taken);
  EXPECT_TRUE(same_state(backend.state(), taken));
}

/// Expects the same steps again from a state that the backend is given, within bounds in m and m/s.
inline void expect_starts_again(Backend& backend, const System& system, double position_m = 0,
                                double velocity_m_per_s = 0) {
  backend.step(7);
  const State once = backend.state();
  backend.step(4);
  backend.set_state(system.start);
  expect_has_taken(backend, system.start);
  backend.step(3);
  backend.step(4);
  const State again = backend.state();
  EXPECT_LE(largest_distance(again.position, once.position), position_m);
  EXPECT_LE(largest_distance(again.velocity, once.velocity), velocity_m_per_s);
}

}  // namespace mssim
