#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "backends/layouts/node_messages.h"
#include "backends/openmp/sliced_bodies.h"
#include "ranks/bodies_part.h"
#include "ranks/session.h"
#include "ranks/standing_messages.h"

namespace mssim {

/// The edge nodes of a rank's part of bodies as messages to the ranks that have them as ghosts: positions and
/// velocities, packed, because edge nodes lie apart.
class GhostMessages final : public NodeMessages {
 public:
  /// `session` must outlive this. `bodies` are those of the part.
  GhostMessages(const Session& session, const BodiesPart& part, const SlicedBodies& bodies);

  void begin(const float* records) override;
  void advance() override { messages_.advance(); }
  void finish(float* records) override;

  /// What they have cost so far.
  RankCosts costs() const;

 private:
  /// Between the records and the arrays of the messages.
  void pack(const float* records);
  void unpack(float* records);

  std::vector<std::uint32_t> edge_slots_;  ///< of each neighbour's after the other, with repetitions
  std::size_t first_ghost_slot_;
  std::vector<float> sent_, received_;  ///< [nodes][position, velocity] in the order of the slots
  StandingMessages messages_;
  double packed_s_ = 0;
};

}  // namespace mssim
