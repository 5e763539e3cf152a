#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "backends/layouts/band_grid.h"
#include "backends/vectors/step_kernels.h"
#include "ranks/messages.h"
#include "ranks/piece.h"

namespace mssim {

/// The columns of a cloth that one rank steps, and the ghost columns beside them, by openmp's own walk: the
/// same bits as there.
class ClothPiece final : public Piece {
 public:
  /// Throws Unsupported for more ranks than the cloth can be cut for, and where the processors of the ranks
  /// cannot give the same bits.
  ClothPiece(const Session& session, const RankJob& job);

  std::vector<NodeRun> taken_by(int rank) const override { return runs_of(with_ghosts(rank)); }
  std::vector<NodeRun> owned_by(int rank) const override { return runs_of(columns_of(rank)); }
  std::size_t scene_nodes() const override { return bands_->layout.rows * columns_; }
  void set_state(const State& state) override { bands_->set_state(state); }
  State state() const override;
  void restart(double seconds) override;
  std::vector<NodeRun> owned_by(int rank, const GridWindow& window) const override;
  State state(const GridWindow& window) const override;
  void step(int count) override { kernel_.step(*bands_, count); }
  RankCosts costs() const override { return messages_->costs(); }
  int threads() const override { return static_cast<int>(bands_->threads); }
  std::string note() const override;

 private:
  /// Makes bands and messages for so many steps between two messages, at the scene's start state.
  void make(const Session& session, const RankJob& job, std::size_t steps);
  /// How many steps there had best be between two messages, by trials of all ranks together: fewer messages
  /// cost more columns that are computed twice. The result has the same bits with any number. Rank 0 decides.
  std::size_t chosen_steps(const Session& session, const RankJob& job);
  /// Seconds that a step takes as the piece is made.
  double trial_seconds(const Session& session);
  /// The columns of the scene that a rank owns.
  ColumnRange columns_of(int rank) const;
  /// Those and its ghosts.
  ColumnRange with_ghosts(int rank) const;
  std::vector<NodeRun> runs_of(ColumnRange columns) const;

  /// The nodes that this rank has, at the scene's start state.
  System nodes_at_start() const;
  /// The part of a window that a rank owns.
  GridWindow part_of_window(int rank, const GridWindow& window) const;
  /// That this rank needs for so many steps between two messages.
  std::uint64_t memory_bytes(std::size_t steps) const;

  SceneSpec scene_;
  int ranks_;
  int rank_;
  std::size_t columns_;  ///< of the scene
  std::size_t ghosts_ = 0;
  const Integrator* integrator_;
  StepKernel<BandGrid> kernel_;
  std::optional<BandGrid> bands_;
  std::optional<NeighbourMessages> messages_;
};

/// Throws Unsupported where a cloth of so many columns cannot be cut for so many ranks.
void require_columns(std::size_t columns, const Integrator& integrator, int ranks);

}  // namespace mssim
