#pragma once

#include <mpi.h>

#include <array>
#include <cstdint>
#include <vector>

#include "backends/layouts/band_grid.h"
#include "backends/layouts/column_messages.h"
#include "ranks/piece.h"
#include "ranks/session.h"

namespace mssim {

/// The columns at the ends of a rank's piece of a cloth as messages to the ranks beside it, straight from and
/// into the arrays of the state: nothing is packed. MPI is told once what goes where (persistent requests).
class NeighbourMessages final : public ColumnMessages {
 public:
  /// `bands` must stay where its arrays are; both must outlive this. Rank r has the columns to the right of
  /// those of rank r - 1.
  NeighbourMessages(const Session& session, BandGrid& bands);
  ~NeighbourMessages() override;

  void begin() override;
  void advance() override;
  void finish() override;

  /// What it has cost so far; it waits in finish().
  const RankCosts& costs() const { return costs_; }

 private:
  /// Does what may fail within the threads of a step, which no exception may leave: all ranks end then.
  template <class Work>
  void attempt(const Work& work) const;
  void add(int neighbour, const float* own, float* ghosts, std::size_t floats);

  const Session& session_;
  std::vector<MPI_Request> requests_;
  std::vector<int> peers_;
  std::uint64_t bytes_a_pass_ = 0;
  RankCosts costs_;
  bool under_way_ = false;
};

}  // namespace mssim
