#include "ranks/bodies_piece.h"

#include <string>

#include "backends/openmp/openmp.h"
#include "ranks/ranks_by_weight.h"
#include "scene/scene_kinds.h"
#include "text/counted.h"

namespace mssim {
namespace {

/// The scene with some of its bodies.
SceneSpec with_bodies(const SceneSpec& scene, const std::vector<BodySpec>& bodies) {
  SceneSpec some = scene;
  std::get<BodiesSpec>(some.content).list = bodies;
  return some;
}

}  // namespace

BodiesPiece::BodiesPiece(const Session& session, const RankJob& job) {
  const std::vector<BodySpec>& list = std::get<BodiesSpec>(job.scene.content).list;
  if (list.size() < static_cast<std::size_t>(session.ranks()))
    throw Unsupported((list.size() == 1 ? "1 body" : std::to_string(list.size()) + " bodies") +
                      " cannot be given to " + counted(static_cast<std::uint64_t>(session.ranks()), "rank") +
                      ": each needs one, so give at most --ranks " + std::to_string(list.size()));
  std::vector<std::size_t> weights;
  for (const BodySpec& body : list) weights.push_back(counts_of(with_bodies(job.scene, {body})).nodes);
  rank_of_ = ranks_by_weight(weights, session.ranks());
  std::size_t first = 0;
  std::vector<BodySpec> own;
  for (std::size_t i = 0; i < list.size(); ++i) {
    bodies_.push_back({first, weights[i]});
    first += weights[i];
    if (rank_of_[i] == session.rank()) own.push_back(list[i]);
  }
  system_ = build_system(with_bodies(job.scene, own));
  backend_ = make_openmp(system_, *job.integrator, job.dt_s, {.threads = job.threads, .roots = job.roots});
}

std::vector<NodeRun> BodiesPiece::taken_by(int rank) const {
  std::vector<NodeRun> runs;
  for (std::size_t i = 0; i < bodies_.size(); ++i)
    if (rank_of_[i] == rank) runs.push_back(bodies_[i]);
  return runs;
}

std::size_t BodiesPiece::scene_nodes() const { return bodies_.back().first + bodies_.back().count; }

std::string BodiesPiece::note() const { return backend_->device() + ", whole bodies"; }

}  // namespace mssim
