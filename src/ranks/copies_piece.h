#pragma once

#include <memory>
#include <vector>

#include "ranks/piece.h"

namespace mssim {

/// The whole scene, on every rank once more, stepped as openmp steps it: what the ranks of a machine take
/// where they have nothing to say to each other, and only share its memory. Rank 0 takes part in the states
/// of mssim; the others must have the same.
class CopiesPiece final : public Piece {
 public:
  CopiesPiece(const Session& session, const RankJob& job);

  std::vector<NodeRun> taken_by(int /*rank*/) const override { return {{0, scene_nodes()}}; }
  std::vector<NodeRun> owned_by(int rank) const override;
  std::size_t scene_nodes() const override { return system_.nodes(); }
  void set_state(const State& state) override { backend_->set_state(state); }
  /// Throws RankFailure where the states of the ranks differ.
  State state() const override;
  void step(int count) override { backend_->step(count); }
  int threads() const override { return backend_->threads(); }
  std::string note() const override;

 private:
  const Session& session_;
  System system_;
  std::unique_ptr<Backend> backend_;
};

}  // namespace mssim
