#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "backends/interface/backend.h"
#include "ranks/messages.h"
#include "scene/spec/scene_spec.h"

namespace mssim {

/// What every rank must know to step its part of a scene.
struct RankJob {
  SceneSpec scene;
  const Integrator* integrator = nullptr;
  double dt_s = 0;
  int threads = 1;  ///< of each rank
  Roots roots = Roots::fast;
  bool copies = false;  ///< each rank steps the whole scene, and none says anything to another
};

/// Nodes of a scene that follow each other.
struct NodeRun {
  std::size_t first = 0, count = 0;
};

/// The part of a scene that one rank steps. The rest of the scene is nowhere in this process.
class Piece {
 public:
  Piece() = default;
  Piece(const Piece&) = delete;
  Piece& operator=(const Piece&) = delete;
  virtual ~Piece() = default;

  /// The nodes of the scene whose states a rank takes, with the ghosts that no message brings before they are
  /// needed, in the order in which its states have them. Rank 0 asks it of all ranks, others of themselves.
  virtual std::vector<NodeRun> taken_by(int rank) const = 0;
  /// The nodes of the scene that a rank steps: every node of the scene is one rank's.
  virtual std::vector<NodeRun> owned_by(int rank) const = 0;
  virtual std::size_t scene_nodes() const = 0;

  /// Takes a state of the nodes of taken_by(this rank).
  virtual void set_state(const State& state) = 0;
  /// The present state of the nodes of owned_by(this rank).
  virtual State state() const = 0;
  /// Goes back to the scene's start state, its positions moved by so many seconds of their velocities. Throws
  /// RankFailure where it cannot.
  virtual void restart(double seconds);
  /// The nodes of a window of a cloth that a rank owns, as the window numbers them. Throws RankFailure.
  virtual std::vector<NodeRun> owned_by(int rank, const GridWindow& window) const;
  /// The present state of those of this rank. Throws RankFailure.
  virtual State state(const GridWindow& window) const;
  /// Takes so many steps, as all ranks do at the same time.
  virtual void step(int count) = 0;

  virtual RankCosts costs() const { return {}; }

  virtual int threads() const = 0;
  /// What a reader of its times should know of how it steps.
  virtual std::string note() const = 0;
};

/// The part of this rank, at the scene's start state. Throws Unsupported, on all ranks alike, where the scene
/// cannot be cut for so many.
std::unique_ptr<Piece> make_piece(const Session& session, const RankJob& job);

/// Throws Unsupported where the scene cannot be cut for so many ranks, as make_piece does in each of them: to
/// be asked before any are started.
void require_cut(const SceneSpec& scene, const Integrator& integrator, int ranks);

/// States between mssim and the pieces: rank 0 has the file of a state (docs/own-backends.md), and each rank
/// its part. No rank holds more than its part and a message. All ranks call these together; they throw
/// RankFailure.

/// Gives every rank what it takes of the state in the file.
void scatter_state(const Session& session, const std::filesystem::path& file, Piece& piece);

/// Writes what every rank owns into the file.
void gather_state(const Session& session, const std::filesystem::path& file, const Piece& piece);

/// Writes what every rank owns of a window of a cloth: the file has its nodes alone.
void gather_window(const Session& session, const std::filesystem::path& file, const Piece& piece,
                   const GridWindow& window);

/// What the steps of all ranks cost since they were last told: the answers to the request `costs`
/// (docs/own-backends.md).
class StepCosts {
 public:
  explicit StepCosts(const LinkSpeed& links) : links_(links) {}

  /// Takes steps with the piece, until all ranks have.
  void step(const Session& session, Piece& piece, int count);
  /// The lines of the answer, on all ranks, which call this together.
  std::vector<std::string> tell(const Session& session, const Piece& piece);

 private:
  LinkSpeed links_;
  RankCosts told_;      ///< what the piece said when it was last asked
  double seconds_ = 0;  ///< of the steps since then
  double met_s_ = 0;    ///< of these, waiting for others at their end
  double steps_ = 0;
};

}  // namespace mssim
