#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "backends/interface/backend.h"
#include "backends/layouts/band_grid.h"
#include "backends/openmp/step_bands.h"
#include "ranks/neighbour_messages.h"
#include "ranks/session.h"
#include "scene/cloth.h"
#include "scene/spec/scene_spec.h"

namespace mssim {

/// What every rank must know to step its part of a scene.
struct RankJob {
  SceneSpec scene;
  const Integrator* integrator = nullptr;
  double dt_s = 0;
  int threads = 1;  ///< of each rank
  Roots roots = Roots::fast;
};

/// The columns of a cloth that one rank steps, and the ghost columns beside them, by openmp's own walk: the
/// same bits as there. The rest of the cloth is nowhere in this process.
class ClothPiece {
 public:
  /// At the scene's start state. Throws Unsupported, on all ranks alike, for more ranks than the cloth can be
  /// cut for, and RankFailure where the processors of the ranks cannot give the same bits.
  ClothPiece(const Session& session, const RankJob& job);
  ClothPiece(const ClothPiece&) = delete;
  ClothPiece& operator=(const ClothPiece&) = delete;

  /// The columns of the scene that a rank owns.
  ColumnRange columns_of(int rank) const;
  /// Those and its ghosts: what a state of it has.
  ColumnRange with_ghosts(int rank) const;
  std::size_t rows() const { return bands_->layout.rows; }
  std::size_t columns() const { return columns_; }  ///< of the scene

  /// A state of the piece, [rows][columns with ghosts].
  void set_state(const State& state) { bands_->set_state(state); }
  /// The same; only its own columns are filled in.
  State state() const { return bands_->state(); }
  void step(int count) { kernel_.step(*bands_, count); }

  int threads() const { return static_cast<int>(bands_->inner_count); }
  int steps_per_pass() const { return static_cast<int>(bands_->steps_per_pass); }
  const NeighbourMessages& messages() const { return *messages_; }
  /// What a reader of its times should know: instruction set, steps an exchange.
  std::string note() const;

 private:
  int ranks_;
  int rank_;
  std::size_t columns_, ghosts_ = 0;
  BandKernel kernel_;
  std::optional<BandGrid> bands_;
  std::optional<NeighbourMessages> messages_;
};

}  // namespace mssim
