#pragma once

#include <cstddef>
#include <vector>

#include "backends/implicit/local_global/block_factor.h"
#include "backends/implicit/local_global/front_schedule.h"
#include "backends/implicit/nodes/node_rows.h"
#include "backends/implicit/nodes/node_slices.h"
#include "backends/vectors/instruction_sets.h"

namespace mssim {

/// What the vector code of fast-springs needs to take steps. Nodes: NodeRows or NodeSlices.
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
  AlignedArray x, v;  ///< fields: the state, m and m/s
  AlignedArray y, w;  ///< fields: x + dt w, m, and the velocities sought, m/s
  AlignedArray e;     ///< field: what is missing for w - v = dt a(y, w), m/s
  AlignedArray fronts;

  LocalGlobalNodes(const System& system, double dt_s, Nodes system_nodes, std::size_t lanes,
                   std::size_t thread_count);
  void set_state(const State& state);
  State state() const;
};

/// The vector code for one instruction set: takes `count` steps.
struct LocalGlobalKernel {
  std::size_t lanes;            ///< floats of a vector
  const char* instruction_set;  ///< Highway's name for it
  bool exact_roots;             ///< as inverse_length (backends/vectors/lanes-inl.h) says
  void (*step_rows)(LocalGlobalNodes<NodeRows>& cloth, int count);
  void (*step_slices)(LocalGlobalNodes<NodeSlices>& bodies, int count);
};

/// The kernels for the instruction sets of this processor, at least one, the best first.
std::vector<LocalGlobalKernel> local_global_kernels();

}  // namespace mssim
