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
#include "platform/machine.h"
#include "ranks/messages.h"
#include "ranks/requests.h"
#include "scene/spec/scene_spec.h"

namespace mssim {

/// Data that every rank needs to step its part of a scene.
struct RankJob {
  SceneSpec scene;
  const Integrator* integrator = nullptr;
  double dt_s = 0;
  int threads = 1;  ///< per rank
  Roots roots = Roots::fast;
  bool copies = false;  ///< each rank steps the whole scene, without communication
};

/// A run of consecutive nodes of a scene.
struct NodeRun {
  std::size_t first = 0, count = 0;
};

/// The part of a scene that one rank steps. This process has nothing of the rest.
class Piece {
 public:
  Piece() = default;
  Piece(const Piece&) = delete;
  Piece& operator=(const Piece&) = delete;
  virtual ~Piece() = default;

  /// The scene's nodes whose states a rank receives: its own and the ghosts that it needs before the first
  /// message, in the order of its states. Rank 0 calls it for all ranks, the others for themselves.
  virtual std::vector<NodeRun> taken_by(int rank) const = 0;
  /// The scene's nodes that a rank steps: every node of the scene is owned by exactly one rank.
  virtual std::vector<NodeRun> owned_by(int rank) const = 0;
  virtual std::size_t scene_nodes() const = 0;

  /// Sets the state of the nodes of taken_by(this rank).
  virtual void set_state(const State& state) = 0;
  /// The current state of the nodes of owned_by(this rank).
  virtual State state() const = 0;
  /// Returns to the scene's start state, with positions moved by `seconds` times their velocities. Throws
  /// RankFailure if it cannot.
  virtual void restart(double seconds);
  /// The nodes of a window of a cloth that a rank owns, numbered within the window. Throws RankFailure.
  virtual std::vector<NodeRun> owned_by(int rank, const GridWindow& window) const;
  /// The current state of those of this rank. Throws RankFailure.
  virtual State state(const GridWindow& window) const;
  /// Takes `count` steps; all ranks call it together.
  virtual void step(int count) = 0;

  virtual RankCosts costs() const { return {}; }

  virtual int threads() const = 0;
  /// As Backend::steps_per_pass.
  virtual int steps_per_pass() const { return 0; }
  /// As Backend::device.
  virtual std::string device() const = 0;
  /// How it steps, for readers of its times.
  virtual std::string note() const = 0;
};

/// This rank's part, at the scene's start state. Both arguments must outlive it. Throws Unsupported, on all
/// ranks, if the scene cannot be cut for this many.
std::unique_ptr<Piece> make_piece(const Session& session, const RankJob& job);

/// Throws Unsupported if the scene cannot be cut for `ranks` ranks, like make_piece on each of them: call it
/// before any are started.
void require_cut(const SceneSpec& scene, const Integrator& integrator, int ranks);

/// make_piece for a cloth, with ghost columns next to its own, and for bodies, whole ones and parts of
/// divided ones. They also throw Unsupported if the ranks' CPUs cannot give bitwise identical results, and
/// make_bodies_piece throws Unavailable if the meshes differ; on all ranks.
std::unique_ptr<Piece> make_cloth_piece(const Session& session, const RankJob& job);
std::unique_ptr<Piece> make_bodies_piece(const Session& session, const RankJob& job);
/// require_cut for the columns of a cloth, and for the bodies of a scene.
void require_columns(std::size_t columns, const Integrator& integrator, int ranks);
void require_shares(const SceneSpec& scene, int ranks);

/// A kernel with which all ranks give bitwise identical results: the best of each rank if that is the same
/// one, else the best that computes roots exactly. `kernels`: those of this CPU, the best first. The variable
/// MSSIM_INSTRUCTION_SET names the best one to be used, to test different CPUs on one machine. Throws
/// Unsupported, on all ranks, if their results would differ.
template <class Data>
StepKernel<Data> common_kernel(const Session& session, std::vector<StepKernel<Data>> kernels, Roots roots) {
  using Kernel = StepKernel<Data>;
  const std::string name = variable("MSSIM_INSTRUCTION_SET");
  const auto first = std::ranges::find_if(
      kernels, [&](const Kernel& kernel) { return kernel.instruction_set == std::string_view(name); });
  if (first != kernels.end()) kernels.erase(kernels.begin(), first);
  const Kernel best = best_kernel(kernels, roots);
  const std::vector<std::string> sets =
      session.gather(std::string(instruction_set_name(best.instruction_set)));
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

/// Transfer of states between mssim and the pieces: rank 0 has the file of a state (docs/protocol.md),
/// and each rank its part. No rank holds more than its part and a message. All ranks call these functions
/// together; they throw RankFailure.

/// Sends every rank its part of the state in the file.
void scatter_state(const Session& session, const std::filesystem::path& file, Piece& piece);

/// Writes the nodes that each rank owns into the file.
void gather_state(const Session& session, const std::filesystem::path& file, const Piece& piece);

/// Writes the owned nodes within a window of a cloth; the file has only the window's nodes.
void gather_window(const Session& session, const std::filesystem::path& file, const Piece& piece,
                   const GridWindow& window);

/// Costs of the steps of all ranks since the last report: the answers to the request `costs`
/// (docs/protocol.md).
class StepCosts {
 public:
  explicit StepCosts(const LinkSpeed& links) : links_(links) {}

  /// Takes steps with the piece, until all ranks have finished.
  void step(const Session& session, Piece& piece, int count);
  /// Number of steps that take about two seconds, judged by the last ones; 1 before the first.
  int steps_to_meeting() const;
  /// The lines of the answer, on all ranks, which call this together.
  std::vector<std::string> tell(const Session& session, const Piece& piece);

 private:
  LinkSpeed links_;
  RankCosts told_;      ///< the piece's costs at the last report
  double seconds_ = 0;  ///< of the steps since then
  double met_s_ = 0;    ///< of these, waiting for others at their end
  double steps_ = 0;
  double last_step_s_ = 0;  ///< seconds per step of the last ones; 0 before them
};

}  // namespace mssim
