#include <cstdint>
#include <limits>
#include <optional>

#include "backends/layouts/band_grid.h"
#include "platform/machine.h"
#include "ranks/piece.h"
#include "scene/builders.h"
#include "text/text.h"

namespace mssim {
namespace {

/// The columns of a cloth that one rank steps, and their neighbouring ghost columns, with openmp's walk and
/// bitwise identical results.
class ClothPiece final : public Piece {
 public:
  ClothPiece(const Session& session, const RankJob& job)
      : session_(session),
        job_(job),
        ranks_(static_cast<std::size_t>(session.ranks())),
        cloth_(std::get<ClothSpec>(job.scene.content)),
        kernel_(common_kernel(session, step_kernels<BandGrid>(*job.integrator), job.roots)) {
    require_columns(cloth_.columns, *job.integrator, session.ranks());
    make(chosen_steps());
  }

  std::vector<NodeRun> taken_by(int rank) const override { return runs_of(with_ghosts(rank)); }
  std::vector<NodeRun> owned_by(int rank) const override { return runs_of(columns_of(rank)); }
  std::size_t scene_nodes() const override { return std::size_t{cloth_.rows} * cloth_.columns; }
  void set_state(const State& state) override { bands_->set_state(state); }
  State state() const override {
    const ColumnRange own = columns_of(session_.rank());
    return state(
        {0, static_cast<std::uint32_t>(own.first), cloth_.rows, static_cast<std::uint32_t>(own.count)});
  }
  void restart(double seconds) override {
    State start = nodes_at_start().start;
    if (seconds != 0)
      for (std::size_t i = 0; i < start.position.size(); ++i)
        start.position[i] += seconds * start.velocity[i];
    bands_->set_state(start);
  }
  std::vector<NodeRun> owned_by(int rank, const GridWindow& window) const override {
    const GridWindow part = part_of_window(rank, window);
    std::vector<NodeRun> runs;
    for (std::size_t row = 0; row < part.rows && part.columns > 0; ++row)
      runs.push_back({row * window.columns + part.column - window.column, part.columns});
    return runs;
  }
  State state(const GridWindow& window) const override {
    GridWindow part = part_of_window(session_.rank(), window);
    if (part.columns == 0) return {};
    part.column -= static_cast<std::uint32_t>(with_ghosts(session_.rank()).first);
    return bands_->state(part);
  }
  void step(int count) override { kernel_.step(*bands_, count); }
  RankCosts costs() const override { return messages_->costs(); }
  int threads() const override { return static_cast<int>(bands_->threads); }
  int steps_per_pass() const override { return static_cast<int>(bands_->steps_per_pass); }
  std::string device() const override { return kernel_.device(); }
  std::string note() const override { return pluralize(bands_->steps_per_pass, "step") + " an exchange"; }

 private:
  /// Makes bands and messages, at the scene's start state, with `steps` steps between two messages.
  void make(std::size_t steps) {
    messages_.reset();
    bands_.reset();
    ghosts_ = ghost_columns(*job_.integrator, steps);
    require_memory(session_, memory_bytes());
    const ColumnRange own = columns_of(session_.rank()), all = with_ghosts(session_.rank());
    const System system = nodes_at_start();
    bands_.emplace(system, std::get<GridPatch>(system.topology), *job_.integrator, job_.dt_s, kernel_.lanes,
                   static_cast<std::size_t>(job_.threads),
                   BandCut{.steps_per_pass = steps, .piece = ColumnRange{own.first - all.first, own.count}});
    messages_.emplace(session_);
    add_edge_columns(*messages_, session_.rank(), *bands_);
    if (ranks_ > 1) bands_->messages = &*messages_;
    bands_->set_state(system.start);
  }
  /// The best number of steps between two messages, by trials of all ranks together: fewer messages mean that
  /// more columns are computed twice. The number does not change the result. Rank 0 decides.
  std::size_t chosen_steps() {
    const Integrator& integrator = *job_.integrator;
    // The cloth's columns per host of this run, approximately: a host's ranks share its last-level cache.
    const auto ranks_on_host = static_cast<std::size_t>(session_.ranks_on_host());
    const std::size_t columns_on_host = cloth_.columns * ranks_on_host / ranks_;
    const GridPatch on_host{cloth_.rows, std::max(1U, static_cast<std::uint32_t>(columns_on_host)),
                            cloth_.spacing_m};
    const std::size_t found = steps_per_pass_for(BandLayout(on_host, kernel_.lanes), integrator,
                                                 ranks_on_host * static_cast<std::size_t>(job_.threads));
    const std::size_t narrowest = cloth_.columns / ranks_;
    const std::size_t usual =
        ranks_ > 1 ? steps_within(std::stoul(session_.share(std::to_string(found))), integrator, narrowest)
                   : found;
    // In a larger piece, messages cost little and the trial takes long.
    constexpr std::size_t largest_tried = 1'000'000;  // nodes
    const bool tries =
        ranks_ > 1 && narrowest * cloth_.rows <= largest_tried && !session_.shares_processors();
    if (session_.share(tries ? "try" : "") != "try") return usual;
    // Required gain of another number: trials are short, and other programs may run.
    constexpr double clearly_faster = 0.95;
    std::vector<std::size_t> candidates{usual};
    for (std::size_t steps = 1; steps * integrator.stage_count <= stages_under_way; steps *= 2)
      if (steps != usual && ghost_columns(integrator, steps) <= narrowest) candidates.push_back(steps);
    std::vector<double> least(candidates.size(), std::numeric_limits<double>::infinity());
    // Alternate, so that another program that runs for a while does not decide.
    constexpr int turns = 2;
    for (int turn = 0; turn < turns; ++turn)
      for (std::size_t i = 0; i < candidates.size(); ++i) {
        make(candidates[i]);
        least[i] = std::min(least[i], trial_seconds());
      }
    least.front() *= clearly_faster;
    const std::size_t chosen =
        candidates[static_cast<std::size_t>(std::ranges::min_element(least) - least.begin())];
    return std::stoul(session_.share(std::to_string(chosen)));
  }
  /// Seconds per step of the piece in its present form.
  double trial_seconds() {
    constexpr double trial_s = 0.01;
    constexpr int trials = 3, most_steps = 500, first_steps = 16;
    const auto seconds_of = [&](int steps) {
      const Stopwatch watch;
      step(steps);
      session_.meet();
      return watch.seconds() / steps;
    };
    seconds_of(first_steps);
    const auto wanted = static_cast<int>(std::min<double>(most_steps, trial_s / seconds_of(first_steps)));
    const int steps = std::stoi(session_.share(std::to_string(std::max(first_steps, wanted))));
    double least = seconds_of(steps);
    for (int trial = 1; trial < trials; ++trial) least = std::min(least, seconds_of(steps));
    return least;
  }
  /// The columns of the scene that a rank owns.
  ColumnRange columns_of(int rank) const {
    return part_of({0, cloth_.columns}, static_cast<std::size_t>(rank), ranks_);
  }
  /// Owned columns and ghosts of a rank.
  ColumnRange with_ghosts(int rank) const {
    return mssim::with_ghosts(columns_of(rank), ghosts_, cloth_.columns);
  }
  std::vector<NodeRun> runs_of(ColumnRange columns) const {
    std::vector<NodeRun> runs;
    for (std::size_t row = 0; row < cloth_.rows; ++row)
      runs.push_back({row * cloth_.columns + columns.first, columns.count});
    return runs;
  }
  /// The nodes of this rank at the scene's start state.
  System nodes_at_start() const {
    const ColumnRange all = with_ghosts(session_.rank());
    System system = build_cloth_window(job_.scene, {.row = 0,
                                                    .column = static_cast<std::uint32_t>(all.first),
                                                    .rows = cloth_.rows,
                                                    .columns = static_cast<std::uint32_t>(all.count)});
    round_start_to_single(system);
    return system;
  }
  /// The part of a window that a rank owns.
  GridWindow part_of_window(int rank, const GridWindow& window) const {
    const ColumnRange own = columns_of(rank);
    const std::size_t begin = std::max<std::size_t>(own.first, window.column);
    const std::size_t end = std::min<std::size_t>(own.end(), window.column + window.columns);
    return {window.row, static_cast<std::uint32_t>(begin), window.rows,
            static_cast<std::uint32_t>(end - std::min(begin, end))};
  }
  /// Memory of this rank with its present ghosts.
  std::uint64_t memory_bytes() const {
    // Per node: its start and mass while the piece is filled, and its state in the bands.
    constexpr std::uint64_t node_bytes =
        2 * sizeof(Vec3d) + sizeof(double) + BandLayout::components * sizeof(float);
    return node_bytes * (cloth_.columns / ranks_ + 2 * ghosts_) * cloth_.rows;
  }

  const Session& session_;
  const RankJob& job_;
  std::size_t ranks_;
  const ClothSpec& cloth_;
  std::size_t ghosts_ = 0;
  StepKernel<BandGrid> kernel_;
  std::optional<BandGrid> bands_;
  std::optional<StandingMessages> messages_;
};

}  // namespace

void require_columns(std::size_t columns, const Integrator& integrator, int ranks) {
  const std::size_t least = ghost_columns(integrator, 1);
  if (ranks > 1 && columns / static_cast<std::size_t>(ranks) < least)
    throw Unsupported("{} cannot be cut for {}: a step of {} needs {} columns in each, so give at most {}",
                      pluralize(columns, "column"), pluralize(static_cast<std::uint64_t>(ranks), "rank"),
                      integrator.name, least, pluralize(std::max<std::size_t>(1, columns / least), "rank"));
}

std::unique_ptr<Piece> make_cloth_piece(const Session& session, const RankJob& job) {
  return std::make_unique<ClothPiece>(session, job);
}

}  // namespace mssim
