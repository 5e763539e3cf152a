#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "backends/interface/backend.h"
#include "backends/layouts/alike_bodies.h"
#include "backends/layouts/node_arrays.h"
#include "backends/layouts/sliced_graph.h"
#include "model/system.h"

namespace mssim {

/// What steps of bodies take, however these lie in memory.
struct BodySteps : SeparateSteps {
  std::size_t threads = 1;
  /// What a thread takes at a time, slices or pieces: of about the same work.
  std::vector<IndexRange> chunks;
  /// Of a thread that waits for others before it offers its core: about as long as a chunk takes.
  int spins = 0;

  using SeparateSteps::SeparateSteps;

 protected:
  /// Makes the pairs, of so many floats each, and lets each thread be the first to write what its range of
  /// `chunks` (ChunkTickets) steps: there the system then takes it from the memory that is nearest to the
  /// thread. `first_float`: of a chunk in a pair, and of what lies behind the last one.
  void make_pairs_where_stepped(std::size_t floats,
                                const std::function<std::size_t(std::size_t chunk)>& first_float);
};

/// How the nodes that one process steps reach those that step their neighbours, which have them as ghosts:
/// what ColumnMessages are for cloths. Once a stage, and between two stages.
class NodeMessages {
 public:
  NodeMessages() = default;
  NodeMessages(const NodeMessages&) = delete;
  NodeMessages& operator=(const NodeMessages&) = delete;
  virtual ~NodeMessages() = default;

  /// The records of the edge nodes in the pair that the next stage gathers are complete: sends them. Does not
  /// wait.
  virtual void begin(const float* records) = 0;
  /// Lets messages that are under way go on. Does not wait.
  virtual void advance() = 0;
  /// Waits until the records of the ghosts are in the pair that the stage gathers.
  /// Throws nothing, like the others: threads of a step call them, one at a time.
  virtual void finish(float* records) = 0;
};

/// Bodies laid out for vectors of `lanes` floats: pairs are [slices][lanes][record_floats]. They may be a
/// part of bodies whose rest other processes step: these are asked for the ghosts once a stage, which lie
/// behind, [ghosts][record_floats].
struct SlicedBodies : BodySteps {
  std::size_t lanes = 0;
  std::vector<std::uint32_t> slot;         ///< [own nodes] SlicedGraph::slot
  std::vector<std::uint32_t> first_entry;  ///< SlicedGraph::first_entry
  AlignedArray entries;                    ///< slice_entries()
  /// [slices][slice_constants][lanes] SlicedGraph's `constants`, and `held` as 0 or 1.
  AlignedArray constants;
  static constexpr std::size_t slice_constants = spring_constant_count + 1;
  /// Of a part, whose `chunks` have the slices without edge nodes and may be empty: as many of the others.
  std::vector<IndexRange> edge_chunks;
  NodeMessages* messages = nullptr;  ///< of a part: what brings its ghosts; null of a whole

  /// Cuts the bodies into slices of `slice_lanes` nodes, for at most `thread_count` threads.
  /// Throws Unsupported like SlicedGraph, and for more nodes than entries can name.
  SlicedBodies(const System& system, const Integrator& method, double dt_s, std::size_t slice_lanes,
               std::size_t thread_count);
  /// Holds a part of bodies: `graph` is that of `system`, and `messages` must be set before the first step.
  SlicedBodies(const System& system, SlicedGraph graph, const Integrator& method, double dt_s,
               std::size_t thread_count);
  /// Takes and gives the states of the own nodes.
  void set_state(const State& state) { write_records(state, slot, base[index(Pair::state)]); }
  State state() const { return read_records(base[index(Pair::state)], slot); }

  std::size_t slices() const { return first_entry.size() - 1; }
};

/// Alike bodies beside each other, one a lane, so that the ends of a spring of all of them are two vectors
/// and nothing is gathered. Each body's nodes follow each other as its springs go, so that a node's force is
/// complete when the walk over the nodes, which computes each spring at its first end, comes to it. Pairs are
/// as `slices` has them.
struct BodyLanes : BodySteps {
  /// A spring whose first end is in another piece. Offsets are where a node's force starts, in floats from
  /// the body's first one: 3 * lanes for each node. A pair has twice that.
  struct CutSpring {
    std::uint32_t first, second;  ///< offsets
    float stiffness_rest;
  };
  /// Nodes [begin, end) of a group.
  struct Piece {
    std::size_t shape;
    std::size_t offset;          ///< where the group's first node starts in a pair, floats
    std::size_t begin, end;      ///< nodes
    std::size_t reach;           ///< behind the last node that springs lead to
    std::vector<CutSpring> cut;  ///< those that end here, ascending by first end
  };

  AlikeSlices slices;
  /// What a group's bodies have in common, without the `bodies`; `other` of a spring is an offset.
  std::vector<AlikeBodies> shapes;
  std::vector<Piece> pieces;
  /// [threads] of the piece that a thread works on, from its body's first node on; zero between pieces.
  std::vector<AlignedArray> forces;

  /// Holds all bodies of a system, cut for at most `thread_count` threads.
  BodyLanes(const System& system, const std::vector<AlikeBodies>& bodies, const Integrator& method,
            double dt_s, std::size_t lane_count, std::size_t thread_count);
  void set_state(const State& state) { slices.write(state, base[index(Pair::state)]); }
  State state() const { return slices.read(base[index(Pair::state)]); }
  /// Those of every shape.
  std::uint64_t stored_springs() const;
};

}  // namespace mssim
