#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "backends/implicit/newton/newton_method.h"
#include "backends/implicit/newton/solver_goal.h"
#include "backends/implicit/nodes/node_fields.h"
#include "backends/implicit/nodes/node_rows.h"
#include "backends/implicit/nodes/node_slices.h"
#include "backends/layouts/aligned_array.h"

namespace mssim {

/// The equation of newton_method.h as the vector code holds it, for Nodes a NodeRows or NodeSlices.
/// Everything is divided by the mass of its node, and products of vectors are weighted with it: that is the
/// same in exact arithmetic, and neither springs nor nodes need to know their masses.
template <class Nodes>
struct VectorEquation {
  Nodes nodes;
  float dt;  ///< s
  const Integrator* integrator;
  SolverGoal goal;
  std::size_t threads;
  SolverWork work;
  AlignedArray x;                 ///< field, m
  AlignedArray v, w, s, z, p, q;  ///< fields, m/s
  AlignedArray e;                 ///< field, m/s
  AlignedArray slopes;            ///< of slopes: A without its diagonal
  AlignedArray inverse;           ///< [vectors][6][lanes] P; zero where nothing moves
  /// [chunks] what they add to a sum, for every second sum.
  std::array<std::vector<double>, 2> sums;

  /// With at most `thread_count` threads.
  VectorEquation(const System& system, Nodes laid_out, const Integrator& method, double dt_s,
                 std::size_t lanes, std::size_t thread_count)
      : nodes(std::move(laid_out)),
        dt(static_cast<float>(dt_s)),
        integrator(&method),
        goal(solver_goal<float>(system, dt_s, system.solver.tolerance)),
        threads(std::clamp<std::size_t>(thread_count, 1, std::max<std::size_t>(1, nodes.chunks.size()))),
        slopes(nodes.slope_floats()),
        inverse(nodes.vectors() * 6 * lanes) {
    for (AlignedArray* field : {&x, &v, &w, &s, &z, &p, &q, &e}) *field = AlignedArray(nodes.field_floats());
    for (std::vector<double>& sum : sums) sum.resize(nodes.chunks.size());
    set_state(system.start);
  }

  void set_state(const State& state) {
    write_field(nodes, state.position, x.data());
    write_field(nodes, state.velocity, v.data());
  }
  State state() const {
    State state;
    state.position = read_field(nodes, x.data());
    state.velocity = read_field(nodes, v.data());
    return state;
  }
};

}  // namespace mssim
