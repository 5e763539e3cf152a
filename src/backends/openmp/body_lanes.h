#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "backends/interface/backend.h"
#include "backends/layouts/aligned_array.h"
#include "backends/layouts/alike_bodies.h"
#include "backends/layouts/alike_slices.h"
#include "integrators/coefficients.h"
#include "model/system.h"

namespace mssim {

/// Alike bodies beside each other, one a lane, so that the ends of a spring of all of them are two vectors
/// and nothing is gathered. Each body's nodes follow each other as its springs go, so that a node's force is
/// complete when the walk over the nodes, which computes each spring at its first end, comes to it.
struct BodyLanes {
  /// What a group's bodies have in common. Offsets are where a node's force starts, in floats from the
  /// body's first one: 3 * lanes for each node. A pair has twice that.
  struct Shape {
    struct Spring {
      std::uint32_t other;   ///< offset
      float stiffness_rest;  ///< AlikeBodies::SpringAhead::stiffness_rest
    };
    float stiffness, damping;
    std::vector<std::uint8_t> pinned;         ///< [nodes]
    std::vector<std::uint32_t> first_spring;  ///< [nodes + 1]
    std::vector<Spring> springs;
  };
  /// A spring whose first end is in another piece.
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
  /// Pieces [begin, end), what a thread takes at a time.
  struct Chunk {
    std::size_t begin, end;
  };

  AlikeSlices slices;
  std::vector<Shape> shapes;
  std::vector<Piece> pieces;
  std::vector<Chunk> chunks;

  const Integrator* integrator = nullptr;
  Coefficients<float> coefficients{};
  Surroundings surroundings{};
  std::size_t threads = 1;
  int spins = 0;  ///< of a thread that waits for others, as long as the largest chunk may take
  /// As `slices` has them; empty where not stored
  std::array<AlignedArray, pair_kinds> pairs;
  std::array<float*, pair_kinds> base{};  ///< of `pairs`, by role: `state` and `next` change places
  /// [threads] of the piece that a thread works on, from its body's first node on; zero between pieces.
  std::vector<AlignedArray> forces;

  /// Holds all bodies of a system, cut for at most `thread_count` threads.
  BodyLanes(const System& system, const std::vector<AlikeBodies>& bodies, const Integrator& method,
            double dt_s, std::size_t lane_count, std::size_t thread_count);
  void set_state(const State& state);
  State state() const;
  /// Those of every shape.
  std::uint64_t stored_springs() const;
};

}  // namespace mssim
