#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "backends/implicit/newton/newton_method.h"
#include "backends/implicit/nodes/node_vectors.h"
#include "backends/layouts/node_arrays.h"

namespace mssim {

/// Slopes of at most this size are stored. Larger ones would come from more distant memory than recomputing
/// them takes time, from a tenth of the memory. On two Zen 4 cores, with other programs running, a product
/// with recomputed slopes took 2 times as long for 2,500 nodes of a cloth, 0.6 of the time for 350,000 and
/// half of it for 38,233 of bodies; for 40,000 of a cloth (4 MiB) neither was consistently faster.
inline constexpr std::size_t most_slope_bytes = std::size_t{4} << 20;

/// The equation of newton_method.h for vector code; Nodes is NodeRows or NodeSlices. Everything is divided by
/// the mass of its node, and products of vectors are weighted with it: that is equivalent in exact
/// arithmetic, and springs and nodes need not know their masses.
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
  AlignedArray slopes;            ///< field of slopes: A without its diagonal; empty if not stored
  AlignedArray y;        ///< field, m: position of A's linearisation if slopes are not stored; else empty
  AlignedArray inverse;  ///< [vectors][6][lanes] P; zero at fixed nodes
  /// [chunks] their parts of a sum, for two alternating sums.
  std::array<std::vector<double>, 2> sums;

  /// With at most `thread_count` threads. Set a state before the first step. Slopes of more than `most_kept`
  /// bytes are not stored.
  VectorEquation(const System& system, double dt_s, std::size_t lanes, std::size_t thread_count,
                 const Integrator& method, std::size_t most_kept = most_slope_bytes)
      : nodes(system, lanes),
        dt(static_cast<float>(dt_s)),
        integrator(&method),
        goal(solver_goal<float>(system, dt_s, system.solver.tolerance)),
        threads(threads_for(nodes.chunks.size(), thread_count)),
        inverse(nodes.vectors() * 6 * lanes) {
    for (AlignedArray* field : {&x, &v, &w, &s, &z, &p, &q, &e}) *field = AlignedArray(nodes.field_floats());
    if (nodes.slope_floats() * sizeof(float) <= most_kept)
      slopes = AlignedArray(nodes.slope_floats());
    else
      y = AlignedArray(nodes.field_floats());
    for (std::vector<double>& sum : sums) sum.resize(nodes.chunks.size());
  }

  std::string note() const { return note_of(work); }
  bool keeps_slopes() const { return y.size() == 0; }

  void set_state(const State& state) { write_fields(nodes, state, x.data(), v.data()); }
  State state() const { return read_fields(nodes, nodes.nodes, x.data(), v.data()); }
};

}  // namespace mssim
