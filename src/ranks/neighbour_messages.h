#pragma once

#include "backends/layouts/band_grid.h"
#include "backends/layouts/column_messages.h"
#include "ranks/rank_costs.h"
#include "ranks/session.h"
#include "ranks/standing_messages.h"

namespace mssim {

/// The columns at the ends of a rank's piece of a cloth as messages to the ranks beside it, straight from and
/// into the arrays of the state: nothing is packed.
class NeighbourMessages final : public ColumnMessages {
 public:
  /// `bands` must stay where its arrays are; both must outlive this. Rank r has the columns to the right of
  /// those of rank r - 1.
  NeighbourMessages(const Session& session, BandGrid& bands);

  void begin() override { messages_.begin(); }
  void advance() override { messages_.advance(); }
  void finish() override { messages_.finish(); }

  const RankCosts& costs() const { return messages_.costs(); }

 private:
  StandingMessages messages_;
};

}  // namespace mssim
