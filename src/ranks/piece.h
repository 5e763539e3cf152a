#pragma once

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "backends/interface/backend.h"
#include "backends/vectors/step_kernels.h"
#include "ranks/messages.h"
#include "ranks/requests.h"
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

/// What make_piece makes of a cloth, with ghost columns beside its own, and of bodies, whole ones and parts
/// of divided ones. They also throw Unsupported where the processors of the ranks cannot give the same bits,
/// and the second Unavailable where the ranks have not the same meshes; on all ranks alike.
std::unique_ptr<Piece> make_cloth_piece(const Session& session, const RankJob& job);
std::unique_ptr<Piece> make_bodies_piece(const Session& session, const RankJob& job);
/// What require_cut asks of so many columns of a cloth, and of the bodies of a scene.
void require_columns(std::size_t columns, const Integrator& integrator, int ranks);
void require_shares(const SceneSpec& scene, int ranks);

/// A kernel with which all ranks give the same bits: the best of each where that is the same one, and else
/// the best that finds roots exactly. `kernels`: those of this processor, the best first; of these the
/// variable MSSIM_INSTRUCTION_SET names the best that counts, by which different processors can be tried on
/// one machine. Throws Unsupported, on all ranks, where their bits would differ.
template <class Data>
StepKernel<Data> common_kernel(const Session& session, std::vector<StepKernel<Data>> kernels, Roots roots) {
  using Kernel = StepKernel<Data>;
  const std::string name = variable("MSSIM_INSTRUCTION_SET");
  const auto first = std::ranges::find_if(
      kernels, [&](const Kernel& kernel) { return kernel.instruction_set == std::string_view(name); });
  if (first != kernels.end()) kernels.erase(kernels.begin(), first);
  const Kernel best = best_kernel(kernels, roots);
  const std::vector<std::string> sets = session.gather(best.instruction_set);
  if (std::ranges::count(sets, sets.front()) == std::ssize(sets)) return best;
  const Kernel exact = best_kernel(kernels, Roots::exact);
  const std::vector<std::string> roundings = session.gather(exact.fuses ? "once" : "twice");
  const auto other = std::ranges::find_if(
      roundings, [&](const std::string& rounding) { return rounding != roundings.front(); });
  if (other == roundings.end()) return exact;
  const auto rank = static_cast<std::size_t>(other - roundings.begin());
  throw Unsupported("{} has {} and {} {}, which round differently: take machines of one kind",
                    session.name_of(0), sets.front(), session.name_of(static_cast<int>(rank)), sets[rank]);
}

/// States between mssim and the pieces: rank 0 has the file of a state (docs/protocol.md), and each rank
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
/// (docs/protocol.md).
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
