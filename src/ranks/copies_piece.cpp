#include "ranks/copies_piece.h"

#include <cstdint>
#include <string>

#include "backends/openmp/openmp.h"
#include "model/state_hash.h"
#include "ranks/host_memory.h"
#include "scene/scene_kinds.h"

namespace mssim {

CopiesPiece::CopiesPiece(const Session& session, const RankJob& job) : session_(session) {
  // Its start with masses, springs, and what openmp makes of them while it is made.
  constexpr std::uint64_t node_bytes = 200, spring_bytes = 70;
  const SceneCounts counts = counts_of(job.scene);
  require_memory(session, node_bytes * counts.nodes + spring_bytes * counts.springs_unique);
  system_ = build_system(job.scene);
  round_start_to_single(system_);
  backend_ = make_openmp(system_, *job.integrator, job.dt_s, {.threads = job.threads, .roots = job.roots});
}

std::vector<NodeRun> CopiesPiece::owned_by(int rank) const {
  return rank == 0 ? taken_by(rank) : std::vector<NodeRun>();
}

State CopiesPiece::state() const {
  State state = backend_->state();
  const std::vector<std::string> hashes = session_.gather(std::to_string(state_hash(state)));
  for (int rank = 1; rank < session_.ranks(); ++rank)
    if (hashes[static_cast<std::size_t>(rank)] != hashes.front())
      throw RankFailure("the copy of " + session_.name_of(rank) + " has another state than that of " +
                        session_.name_of(0));
  return state;
}

std::string CopiesPiece::note() const { return backend_->device() + ", a copy of the scene each"; }

}  // namespace mssim
