#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "backends/interface/backend.h"
#include "backends/layouts/aligned_array.h"
#include "backends/layouts/node_messages.h"
#include "backends/layouts/node_records.h"
#include "backends/layouts/sliced_graph.h"
#include "integrators/coefficients.h"
#include "model/system.h"

namespace mssim {

/// Bodies laid out for vectors of `lanes` floats: what the vector code needs to take steps, with one
/// integrator and one dt. They may be a part of bodies whose rest other processes step: these are asked for
/// the ghosts once a stage.
struct SlicedBodies {
  /// Slices [begin, end), what a thread takes at a time.
  struct Chunk {
    std::size_t begin, end;
  };

  std::size_t lanes = 0;
  std::vector<std::uint32_t> slot;         ///< [own nodes] SlicedGraph::slot
  std::vector<std::uint32_t> first_entry;  ///< SlicedGraph::first_entry
  AlignedArray entries;                    ///< slice_entries()
  /// [slices][3][lanes] SlicedGraph's stiffness, damping and `held`, the last as 0 or 1.
  AlignedArray constants;

  const Integrator* integrator = nullptr;
  Coefficients<float> coefficients{};
  Surroundings surroundings{};
  std::size_t threads = 1;
  /// Chunks of about the same work; in a part those of the slices without edge nodes, which may be empty.
  std::vector<Chunk> chunks;
  std::vector<Chunk> edge_chunks;    ///< as many of the other slices; none of a whole
  NodeMessages* messages = nullptr;  ///< of a part: what brings its ghosts; null of a whole
  /// [slices][lanes][record_floats], then [ghosts][record_floats]; empty where not stored
  std::array<AlignedArray, pair_kinds> pairs;
  std::array<float*, pair_kinds> base{};  ///< of `pairs`, by role: `state` and `next` change places

  /// Cuts the bodies into slices of `slice_lanes` nodes, for at most `thread_count` threads.
  /// Throws Unsupported like SlicedGraph, and for more nodes than entries can name.
  SlicedBodies(const System& system, const Integrator& method, double dt_s, std::size_t slice_lanes,
               std::size_t thread_count);
  /// Holds a part of bodies: `graph` is that of `system`, and `messages` must be set before the first step.
  SlicedBodies(const System& system, SlicedGraph graph, const Integrator& method, double dt_s,
               std::size_t thread_count);
  /// Takes and gives the states of the own nodes.
  void set_state(const State& state);
  State state() const;

  std::size_t slices() const { return first_entry.size() - 1; }
};

}  // namespace mssim
