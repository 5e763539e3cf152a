#pragma once

#include <mpi.h>

#include <span>
#include <string>
#include <vector>

#include "ranks/rank_failure.h"

namespace mssim {

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
  /// The same for a request that nothing but the user's next wish completes: sleeps meanwhile, however long
  /// it takes.
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

}  // namespace mssim
