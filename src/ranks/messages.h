#pragma once

#include <mpi.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "backends/layouts/band_grid.h"
#include "backends/openmp/bodies.h"
#include "platform/machine.h"
#include "ranks/shares.h"

namespace mssim {

/// What a rank has done for others in all its steps so far.
struct RankCosts {
  double waited_s = 0;  ///< for messages that the next columns or nodes needed
  /// Bringing together what was sent, bringing it across where the processor has to, and putting in place
  /// what came.
  double packed_s = 0;
  std::uint64_t bytes = 0;     ///< sent
  std::uint64_t messages = 0;  ///< the same
};

/// Adds the seconds that it lives to such a number.
class SecondsAdded {
 public:
  explicit SecondsAdded(double& seconds) : seconds_(seconds) {}
  ~SecondsAdded() { seconds_ += watch_.seconds(); }
  SecondsAdded(const SecondsAdded&) = delete;
  SecondsAdded& operator=(const SecondsAdded&) = delete;

 private:
  double& seconds_;
  Stopwatch watch_;
};

/// Longest wait for a message of another rank, s. All ranks do the same work at the same time: one that is
/// silent for so long has ended, or its host has.
inline constexpr double longest_silence_s = 20;

/// MPI, from its start to its end: which rank this process is, and how the ranks wait for each other. One
/// thread at a time calls it. Every wait has an end: a rank that no longer answers becomes a RankFailure.
class Session {
 public:
  /// Starts MPI. Throws RankFailure where that fails, or where a thread other than this one may not call it.
  Session(int* argc, char*** argv);
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
  /// Ends MPI, together with all other ranks; not where an exception is on its way.
  ~Session();

  int rank() const { return rank_; }
  int ranks() const { return static_cast<int>(hosts_.size()); }
  /// "rank 3 on HOST".
  std::string name_of(int rank) const;
  const std::vector<std::string>& hosts() const { return hosts_; }  ///< [ranks] by rank
  int rank_on_host() const { return rank_on_host_; }
  int ranks_on_host() const { return ranks_on_host_; }  ///< of the host of this rank
  /// Whether waits let other ranks have the processor: where the ranks of a host have more threads than it
  /// has processors.
  void share_processors(bool share) { shares_ = share; }
  bool shares_processors() const { return shares_; }

  /// Ends all ranks, with a sentence about this one on stderr.
  [[noreturn]] void give_up(const std::string& sentence) const;

  /// Waits until all requests are complete. `peers`: the ranks that they wait for, for the failure.
  void wait(std::span<MPI_Request> requests, std::span<const int> peers) const;
  /// Waits for a request that only the user's next request completes: sleeps meanwhile, however long it
  /// takes.
  static void wait_idle(MPI_Request& request);
  /// Waits for all ranks.
  void meet() const;
  /// The text that rank 0 gives, for all ranks.
  std::string share(std::string text) const;
  /// The texts of all ranks, for all of them.
  std::vector<std::string> gather(const std::string& text) const;

 private:
  std::vector<int> others() const;

  int rank_ = 0;
  std::vector<std::string> hosts_;
  int rank_on_host_ = 0, ranks_on_host_ = 1;
  bool shares_ = false;
};

/// Where an MPI function has not succeeded: throws RankFailure. `action`: "sending a state".
void check_mpi(int result, const char* action);

/// Messages to and from other ranks that go again and again between the same places: MPI is told once what
/// goes where (persistent requests). Threads of a step call them, one at a time, which no exception may
/// leave: where something fails, all ranks end.
class StandingMessages : public ColumnMessages {
 public:
  explicit StandingMessages(const Session& session) : session_(session) {}
  ~StandingMessages() override;

  /// `sent` goes to a rank, and `received` comes from there; both must stay where they are. Throws
  /// RankFailure.
  void add(int rank, std::span<const float> sent, std::span<float> received);

  /// Starts all.
  void begin() override;
  void advance() override;
  /// Waits until all have arrived, and what was sent may change again.
  void finish() override;

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

/// The columns at the ends of a rank's piece of a cloth as messages to the ranks beside it, straight from and
/// into the arrays of the state: nothing is packed.
class NeighbourMessages final : public StandingMessages {
 public:
  /// `bands` must stay where its arrays are; both must outlive this. Rank r has the columns to the right of
  /// those of rank r - 1.
  NeighbourMessages(const Session& session, BandGrid& bands);
};

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
  std::vector<std::uint32_t> edge_slots_;  ///< of each neighbour's after the other, with repetitions
  std::size_t first_ghost_slot_;
  std::vector<float> sent_, received_;  ///< [nodes][position, velocity] in the order of the slots
  StandingMessages messages_;
  double packed_s_ = 0;
};

/// Throws Unavailable, on all ranks alike, where a host has not the memory for its ranks. `bytes`: of each.
void require_memory(const Session& session, std::uint64_t bytes);

/// How fast messages go between ranks that follow each other, where that is slowest.
struct LinkSpeed {
  double latency_s = 0;         ///< half the time of a few bytes there and back
  double bytes_per_second = 0;  ///< of a large message, with another one on its way back
};

/// Measures it, by messages that go there and back: first between ranks 0 and 1, 2 and 3, ... at the same
/// time, then between 1 and 2, 3 and 4, ... All ranks call this together, and get the same. Nothing where
/// there is one rank.
LinkSpeed measure_links(const Session& session);

}  // namespace mssim
