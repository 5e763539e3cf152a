#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "backends/implicit/local_global/factor.h"
#include "backends/implicit/nodes/node_vectors.h"

namespace mssim {

/// Distribution of parts over threads and phases. Phase 0 has whole subtrees of the tree of parts; each later
/// phase has parts whose children are done. Upwards the phases follow each other, and each thread processes
/// its items in order; downwards everything is reversed. It does not affect the result.
struct FrontSchedule {
  /// [phases][threads] items: parts, children before parents.
  std::vector<std::vector<std::vector<IndexRange>>> phases;

  FrontSchedule(const BlockFactor& factor, std::size_t threads);
};

/// Data of fast-springs for the vector code. Nodes: NodeRows or NodeSlices.
template <class Nodes>
struct LocalGlobalNodes {
  /// A free node, by its place in the order of elimination.
  struct Place {
    std::size_t offset;  ///< of its x in a field
    float mass;          ///< kg
  };

  Nodes nodes;
  BlockFactor factor;
  std::size_t threads;
  FrontSchedule schedule;
  float dt;  ///< s
  std::uint32_t iterations;
  std::vector<Place> places;
  AlignedArray x, v;    ///< fields: the state, m and m/s
  AlignedArray y, w;    ///< fields: x + dt w, m, and the unknown velocities, m/s
  AlignedArray e;       ///< field: the residual of w - v = dt a(y, w), m/s
  AlignedArray fronts;  ///< [parts][3][rows], each at its BlockFactor::Block::front

  /// With at most `thread_count` threads. Set a state before the first step.
  LocalGlobalNodes(const System& system, double dt_s, std::size_t lanes, std::size_t thread_count)
      : LocalGlobalNodes(system, {system, dt_s}, dt_s, lanes, thread_count) {}
  void set_state(const State& state) { write_fields(nodes, state, x.data(), v.data()); }
  State state() const { return read_fields(nodes, nodes.nodes, x.data(), v.data()); }

 private:
  LocalGlobalNodes(const System& system, const StepMatrix& matrix, double dt_s, std::size_t lanes,
                   std::size_t thread_count);
};

}  // namespace mssim
