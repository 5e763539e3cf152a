#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "backends/openmp/bodies.h"
#include "backends/vectors/step_kernels.h"
#include "ranks/messages.h"
#include "ranks/piece.h"
#include "ranks/shares.h"

namespace mssim {

/// The bodies of a scene that one rank steps, whole ones and parts of divided ones, by openmp's own vector
/// code: the same bits as there. Bodies do not touch each other: only the ranks of a divided one have
/// something to say to each other while they step.
class BodiesPiece final : public Piece {
 public:
  /// Throws Unsupported for more ranks than the bodies can be given to, and where the processors of the ranks
  /// cannot give the same bits; Unavailable where the ranks have not the same meshes. All ranks do so alike.
  BodiesPiece(const Session& session, const RankJob& job);

  /// Without ghosts: messages bring those before the first stage.
  std::vector<NodeRun> taken_by(int rank) const override { return runs_[static_cast<std::size_t>(rank)]; }
  std::vector<NodeRun> owned_by(int rank) const override { return taken_by(rank); }
  std::size_t scene_nodes() const override { return scene_nodes_; }
  void set_state(const State& state) override {
    whole_ ? whole_->set_state(state) : bodies_->set_state(state);
  }
  State state() const override { return whole_ ? whole_->state() : bodies_->state(); }
  void step(int count) override { whole_ ? whole_->step(count) : kernel_.step(*bodies_, count); }
  RankCosts costs() const override { return messages_ ? messages_->costs() : RankCosts{}; }
  int threads() const override { return whole_ ? whole_->threads() : static_cast<int>(bodies_->threads); }
  std::string note() const override;

 private:
  StepKernel<SlicedBodies> kernel_;
  std::vector<std::vector<BodyShare>> shares_;  ///< [bodies of the scene]
  std::vector<std::vector<NodeRun>> runs_;      ///< [ranks] on rank 0; elsewhere only its own
  std::size_t scene_nodes_ = 0;
  std::unique_ptr<Backend> whole_;      ///< openmp, where this rank has whole bodies only
  std::optional<SlicedBodies> bodies_;  ///< else
  std::optional<GhostMessages> messages_;
};

/// Throws Unsupported where the bodies of the scene cannot be given to so many ranks.
void require_shares(const SceneSpec& scene, int ranks);

}  // namespace mssim
