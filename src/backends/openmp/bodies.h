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

/// Parameters of steps of bodies, independent of the layout.
template <class Real>
struct BodySteps : SeparateSteps<Real> {
  std::size_t threads = 1;
  /// Units of work for threads, slices or pieces, of about equal cost.
  std::vector<IndexRange> chunks;
  /// Spins of a waiting thread before it yields its core: about as long as a chunk takes.
  int spins = 0;

  using SeparateSteps<Real>::SeparateSteps;

 protected:
  /// Allocates the pairs, `size` numbers each, and lets each thread first write the data of its range of
  /// `chunks` (ChunkTickets), so the system takes that memory from the thread's nearest node. `first_number`:
  /// offset of a chunk in a pair, and of the data after the last one.
  void make_pairs_where_stepped(std::size_t size,
                                const std::function<std::size_t(std::size_t chunk)>& first_number);
};

/// Exchange of nodes with the processes that have them as ghosts, once per stage, between two stages: the
/// counterpart of ColumnMessages for bodies.
template <class Real>
class NodeMessages {
 public:
  NodeMessages() = default;
  NodeMessages(const NodeMessages&) = delete;
  NodeMessages& operator=(const NodeMessages&) = delete;
  virtual ~NodeMessages() = default;

  /// Sends the complete records of the edge nodes in the pair that the next stage gathers. Does not wait.
  virtual void begin(const Real* records) = 0;
  /// Lets messages progress. Does not wait.
  virtual void advance() = 0;
  /// Waits until the ghosts' records are in the pair that the stage gathers. Must not throw, like the other
  /// functions: threads of a step call them, one at a time.
  virtual void finish(Real* records) = 0;
};

/// Bodies laid out for vectors of `lanes` numbers: pairs are [slices][lanes][record_floats]. They may be a
/// part of bodies whose rest other processes step: these send the ghosts once per stage, which follow as
/// [ghosts][record_floats].
template <class Real>
struct SlicedBodiesOf : BodySteps<Real> {
  std::size_t lanes = 0;
  std::vector<std::uint32_t> slot;         ///< [own nodes] SlicedGraph::slot
  std::vector<std::uint32_t> first_entry;  ///< SlicedGraph::first_entry
  AlignedArrayOf<Real> entries;            ///< slice_entries()
  /// [slices][slice_constants][lanes] SlicedGraph's `constants`, and `held` as 0 or 1.
  AlignedArrayOf<Real> constants;
  static constexpr std::size_t slice_constants = spring_constant_count + 1;
  /// In a part, `chunks` has the slices without edge nodes and may be empty; this has as many chunks of the
  /// others.
  std::vector<IndexRange> edge_chunks;
  NodeMessages<Real>* messages = nullptr;  ///< brings the ghosts of a part; null for a whole

  /// Divides the bodies into slices of `slice_lanes` nodes, for at most `thread_count` threads. Throws
  /// Unsupported like SlicedGraph, and for more nodes than entries can address.
  SlicedBodiesOf(const System& system, const Integrator& method, double dt_s, std::size_t slice_lanes,
                 std::size_t thread_count);
  /// Lays out a part of bodies: `graph` is that of `system`. Set `messages` before the first step.
  SlicedBodiesOf(const System& system, SlicedGraphOf<Real> graph, const Integrator& method, double dt_s,
                 std::size_t thread_count);
  /// Sets and returns the states of the own nodes.
  void set_state(const State& state) { write_records(state, slot, this->base[index(Pair::state)]); }
  State state() const { return read_records<Real>(this->base[index(Pair::state)], slot); }

  std::size_t slices() const { return first_entry.size() - 1; }
};
using SlicedBodies = SlicedBodiesOf<float>;

/// Alike bodies, one per lane, so the ends of a spring of all of them are two vectors and no gather is
/// needed. Each body's nodes are ordered along its springs, so the force on a node is complete when the walk
/// over the nodes, which computes each spring at its first end, reaches it. Pairs are laid out as in
/// `slices`.
template <class Real>
struct BodyLanesOf : BodySteps<Real> {
  /// A spring whose first end is in another piece. Offsets are those of a node's force, in numbers from the
  /// body's first one: 3 * lanes per node. Offsets in a pair are twice as large.
  struct CutSpring {
    std::uint32_t first, second;  ///< offsets
    Real stiffness_rest;
  };
  /// Nodes [begin, end) of a group.
  struct Piece {
    std::size_t shape;
    std::size_t offset;          ///< start of the group's first node in a pair, numbers
    std::size_t begin, end;      ///< nodes
    std::size_t reach;           ///< one past the last node that springs reach
    std::vector<CutSpring> cut;  ///< springs that end here, ascending by first end
  };

  AlikeSlices slices;
  /// Data that a group's bodies share, without the `bodies`; `other` of a spring is an offset.
  std::vector<AlikeBodiesOf<Real>> shapes;
  std::vector<Piece> pieces;
  /// [threads] forces of the thread's current piece, from its body's first node on; zero between pieces.
  std::vector<AlignedArrayOf<Real>> forces;

  /// Lays out all bodies of a system, divided for at most `thread_count` threads.
  BodyLanesOf(const System& system, const std::vector<AlikeBodiesOf<Real>>& bodies, const Integrator& method,
              double dt_s, std::size_t lane_count, std::size_t thread_count);
  void set_state(const State& state) { slices.write(state, this->base[index(Pair::state)]); }
  State state() const { return slices.template read<Real>(this->base[index(Pair::state)]); }
  /// Springs of all shapes.
  std::uint64_t stored_springs() const;
};
using BodyLanes = BodyLanesOf<float>;

}  // namespace mssim
