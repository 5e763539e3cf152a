#pragma once

#include <memory>
#include <vector>

#include "ranks/piece.h"

namespace mssim {

/// Some whole bodies of a scene, stepped as openmp steps them. Bodies do not touch each other: ranks have
/// nothing to say to each other while they step.
class BodiesPiece final : public Piece {
 public:
  /// Throws Unsupported for more ranks than bodies.
  BodiesPiece(const Session& session, const RankJob& job);

  std::vector<NodeRun> taken_by(int rank) const override;
  std::vector<NodeRun> owned_by(int rank) const override { return taken_by(rank); }
  std::size_t scene_nodes() const override;
  void set_state(const State& state) override { backend_->set_state(state); }
  State state() const override { return backend_->state(); }
  void step(int count) override { backend_->step(count); }
  int threads() const override { return backend_->threads(); }
  std::string note() const override;

 private:
  std::vector<NodeRun> bodies_;  ///< [bodies of the scene] its nodes
  std::vector<int> rank_of_;     ///< [bodies of the scene]
  System system_;
  std::unique_ptr<Backend> backend_;
};

}  // namespace mssim
