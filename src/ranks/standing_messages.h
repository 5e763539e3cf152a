#pragma once

#include <mpi.h>

#include <cstdint>
#include <span>
#include <vector>

#include "ranks/rank_costs.h"
#include "ranks/session.h"

namespace mssim {

/// Messages to and from other ranks that go again and again between the same places: MPI is told once what
/// goes where (persistent requests). Threads of a step call them, one at a time, which no exception may
/// leave: where something fails, all ranks end.
class StandingMessages {
 public:
  explicit StandingMessages(const Session& session) : session_(session) {}
  StandingMessages(const StandingMessages&) = delete;
  StandingMessages& operator=(const StandingMessages&) = delete;
  ~StandingMessages();

  /// `sent` goes to a rank, and `received` comes from there; both must stay where they are. Throws
  /// RankFailure.
  void add(int rank, std::span<const float> sent, std::span<float> received);

  /// Starts all. Does not wait.
  void begin();
  /// Lets those under way go on. Does not wait.
  void advance();
  /// Waits until all have arrived, and what was sent may change again.
  void finish();

  /// What they have cost so far; this rank waits in finish().
  const RankCosts& costs() const { return costs_; }

 private:
  /// Does what may fail within the threads of a step.
  template <class Work>
  void attempt(const Work& work) const;

  const Session& session_;
  std::vector<MPI_Request> requests_;
  std::vector<int> peers_;
  std::uint64_t bytes_ = 0;  ///< sent each time
  RankCosts costs_;
  bool under_way_ = false;
};

}  // namespace mssim
