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

/// Costs of a rank's communication in all its steps so far.
struct RankCosts {
  double waited_s = 0;  ///< waiting for messages that the next columns or nodes needed
  /// Packing, transmission if the CPU performs it, and unpacking.
  double packed_s = 0;
  std::uint64_t bytes = 0;     ///< sent
  std::uint64_t messages = 0;  ///< sent
};

/// Adds the seconds of its lifetime to a number.
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

/// Longest wait for a message of another rank, s. Ranks meet after a few seconds of steps, however unequal
/// their work (StepCosts::steps_to_meeting), so a rank that is silent for so long has ended, or its host has.
/// Only meshes may take longer: a host may have them already, and TetGen has limits of its own.
inline constexpr double longest_silence_s = 20, longest_meshing_s = 3600;

/// An MPI session: the rank of this process, and waiting for other ranks. One thread at a time may call it.
/// Every wait has a time limit: a rank that does not answer causes a RankFailure.
class Session {
 public:
  /// Starts MPI. Throws RankFailure if that fails, or if MPI does not allow calls from several threads.
  Session(int* argc, char*** argv);
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
  /// Ends MPI, together with all other ranks; during an exception it does not.
  ~Session();

  int rank() const { return rank_; }
  int ranks() const { return static_cast<int>(hosts_.size()); }
  /// "rank 3 on HOST".
  std::string name_of(int rank) const;
  const std::vector<std::string>& hosts() const { return hosts_; }  ///< [ranks]
  int ranks_on_host() const { return ranks_on_host_; }              ///< on this rank's host
  /// Whether waits yield the CPU to other ranks: if a host's ranks have more threads than it has CPUs.
  void share_processors(bool share) { shares_ = share; }
  bool shares_processors() const { return shares_; }

  /// Ends all ranks, with a sentence about this one on stderr.
  [[noreturn]] void give_up(const std::string& sentence) const;

  /// Waits until all requests are complete. `peers`: the ranks that they wait for, for the failure message.
  void wait(std::span<MPI_Request> requests, std::span<const int> peers) const;
  /// Waits for a request that only the next request from mssim completes: sleeps meanwhile, without a time
  /// limit.
  static void wait_idle(MPI_Request& request);
  /// Sets the longest wait from now on.
  void wait_at_most(double seconds) const { longest_wait_s_ = seconds; }
  /// Barrier of all ranks.
  void meet() const;
  /// The text of rank 0, on all ranks.
  std::string share(std::string text) const;
  /// The texts of all ranks, for all of them.
  std::vector<std::string> gather(const std::string& text) const;

 private:
  std::vector<int> others() const;

  int rank_ = 0;
  std::vector<std::string> hosts_;
  int ranks_on_host_ = 1;
  mutable double longest_wait_s_ = longest_silence_s;
  bool shares_ = false;
};

/// Throws RankFailure if an MPI function failed. `action`: for example "sending a state".
void check_mpi(int result, const char* action);

/// Repeated messages between the same buffers of this and other ranks: MPI learns them once (persistent
/// requests). Threads of a step call these functions, one at a time; an exception must not leave them, so on
/// failure all ranks end.
class StandingMessages final : public ColumnMessages {
 public:
  explicit StandingMessages(const Session& session) : session_(session) {}
  ~StandingMessages() override;

  /// Adds a message of `sent` to a rank and one from it to `received`; both must stay at their address.
  /// Throws RankFailure.
  void add(int rank, std::span<const float> sent, std::span<float> received);

  /// Starts all messages.
  void begin() override;
  void advance() override;
  /// Waits until all have arrived and the sent data may change again.
  void finish() override;

  /// Their costs so far; this rank waits in finish().
  const RankCosts& costs() const { return costs_; }

 private:
  /// Executes work that may fail, within a step's threads.
  template <class Work>
  void attempt(const Work& work) const;

  const Session& session_;
  std::vector<MPI_Request> requests_;
  std::vector<int> peers_;
  std::uint64_t bytes_ = 0;  ///< sent each time
  RankCosts costs_;
  bool under_way_ = false;
};

/// Adds messages of the edge columns of a rank's piece of a cloth to its neighbours, directly from and to the
/// arrays of the state: nothing is packed. The arrays of `bands` must stay at their address. Rank r has the
/// columns to the right of those of rank r - 1.
void add_edge_columns(StandingMessages& messages, int rank, BandGrid& bands);

/// The edge nodes of a rank's part of bodies as messages to the ranks that have them as ghosts: positions and
/// velocities, packed, because edge nodes are not contiguous.
class GhostMessages final : public NodeMessages<float> {
 public:
  /// `session` must outlive this object. `bodies` are those of the part.
  GhostMessages(const Session& session, const BodiesPart& part, const SlicedBodies& bodies);

  void begin(const float* records) override;
  void advance() override { messages_.advance(); }
  void finish(float* records) override;

  /// Their costs so far.
  RankCosts costs() const;

 private:
  std::vector<std::uint32_t> edge_slots_;  ///< those of one neighbour after the other, with repetitions
  std::size_t first_ghost_slot_;
  std::vector<float> sent_, received_;  ///< [nodes][position, velocity] in the order of the slots
  StandingMessages messages_;
  double packed_s_ = 0;
};

/// Throws Unavailable, on all ranks, if a host has too little memory for its ranks. `bytes`: per rank.
void require_memory(const Session& session, std::uint64_t bytes);

/// Speed of messages between consecutive ranks, over the slowest link.
struct LinkSpeed {
  double latency_s = 0;         ///< half the time of a few bytes there and back
  double bytes_per_second = 0;  ///< for a large message, with another one in the opposite direction
};

/// Measures messages there and back: first between ranks 0 and 1, 2 and 3, ... simultaneously, then between 1
/// and 2, 3 and 4, ... All ranks call this together and get the same result; nothing if there is only one
/// rank.
LinkSpeed measure_links(const Session& session);

}  // namespace mssim
