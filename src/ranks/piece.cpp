#include "ranks/piece.h"

#include <fcntl.h>
#include <sys/mman.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <sstream>
#include <utility>

#include "backends/openmp/openmp.h"
#include "model/system.h"
#include "platform/process.h"
#include "scene/scene_kinds.h"
#include "text/text.h"

namespace mssim {
namespace {

/// The whole scene, copied on every rank and stepped like openmp, to measure ranks that share a machine's
/// memory without communicating. Only rank 0 exchanges states with mssim; the others must have equal states.
class CopiesPiece final : public Piece {
 public:
  CopiesPiece(const Session& session, const RankJob& job) : session_(session) {
    // Start with masses, springs, and the memory that openmp needs during construction.
    constexpr std::uint64_t node_bytes = 200, spring_bytes = 70;
    const SceneCounts counts = counts_of(job.scene);
    require_memory(session, node_bytes * counts.nodes + spring_bytes * counts.springs_unique);
    system_ = build_system(job.scene);
    round_start_to_single(system_);
    backend_ = make_openmp(system_, *job.integrator, job.dt_s, {.threads = job.threads, .roots = job.roots});
  }

  std::vector<NodeRun> taken_by(int /*rank*/) const override { return {{0, scene_nodes()}}; }
  std::vector<NodeRun> owned_by(int rank) const override {
    return rank == 0 ? taken_by(rank) : std::vector<NodeRun>();
  }
  std::size_t scene_nodes() const override { return system_.nodes(); }
  void set_state(const State& state) override { backend_->set_state(state); }
  /// Throws RankFailure if the states of the ranks differ.
  State state() const override {
    State state = backend_->state();
    const std::vector<std::string> hashes = session_.gather(std::to_string(state_hash(state)));
    for (int rank = 1; rank < session_.ranks(); ++rank)
      if (hashes[static_cast<std::size_t>(rank)] != hashes.front())
        throw RankFailure(fmt::format("the copy of {} has a different state from that of {}",
                                      session_.name_of(rank), session_.name_of(0)));
    return state;
  }
  void step(int count) override { backend_->step(count); }
  int threads() const override { return backend_->threads(); }
  int steps_per_pass() const override { return backend_->steps_per_pass(); }
  std::string device() const override { return backend_->device(); }
  std::string note() const override { return "a copy of the scene per rank"; }

 private:
  const Session& session_;
  System system_;
  std::unique_ptr<Backend> backend_;
};

[[noreturn]] void refuse_windows() { throw RankFailure("mssim requests windows without a cloth"); }

/// Maximum number of nodes in a message.
constexpr std::size_t nodes_at_once = std::size_t{1} << 18;
constexpr int state_tag = 2;

/// The file of a state, [2: positions, velocities][nodes] vectors, mapped into memory. mssim made it and does
/// not change its size.
class MappedState {
 public:
  MappedState(const std::filesystem::path& file, std::size_t nodes) : nodes_(nodes) {
    const Descriptor open(::open(file.c_str(), O_RDWR | O_CLOEXEC));
    void* memory = open.is_open()
                       ? ::mmap(nullptr, bytes(), PROT_READ | PROT_WRITE, MAP_SHARED, open.get(), 0)
                       : MAP_FAILED;
    if (memory == MAP_FAILED)
      throw RankFailure(fmt::format("rank 0 cannot open {} ({}): it must run on the machine of mssim",
                                    file.string(), std::strerror(errno)));
    vectors_ = static_cast<Vec3d*>(memory);
  }
  ~MappedState() { ::munmap(vectors_, bytes()); }
  MappedState(const MappedState&) = delete;
  MappedState& operator=(const MappedState&) = delete;

  Vec3d* position(std::size_t node) const { return vectors_ + node; }
  Vec3d* velocity(std::size_t node) const { return vectors_ + nodes_ + node; }

 private:
  std::size_t bytes() const { return 2 * nodes_ * sizeof(Vec3d); }
  std::size_t nodes_;
  Vec3d* vectors_ = nullptr;
};

/// The nodes of some runs, as many at a time as fit in a message.
std::vector<std::vector<NodeRun>> in_messages(const std::vector<NodeRun>& runs) {
  std::vector<std::vector<NodeRun>> messages;
  std::size_t room = 0;
  for (NodeRun rest : runs)
    while (rest.count > 0) {
      if (room == 0) {
        messages.emplace_back();
        room = nodes_at_once;
      }
      const std::size_t count = std::min(room, rest.count);
      messages.back().push_back({rest.first, count});
      rest = {rest.first + count, rest.count - count};
      room -= count;
    }
  return messages;
}

/// Buffer for the states of some nodes: first all positions, then all velocities.
struct Message {
  std::size_t nodes = 0;
  std::vector<Vec3d> vectors;

  explicit Message(const std::vector<NodeRun>& runs) {
    for (const NodeRun& run : runs) nodes += run.count;
    vectors.resize(2 * nodes);
  }
  Vec3d* positions() { return vectors.data(); }
  Vec3d* velocities() { return vectors.data() + nodes; }
};

/// Calls `pass` for every message between rank 0 and a rank that involves this process, with the rank, the
/// runs and the message.
template <class RunsOf, class Pass>
void for_each_message(const Session& session, const RunsOf& runs_of, const Pass& pass) {
  for (int rank = 0; rank < session.ranks(); ++rank) {
    if (session.rank() != 0 && session.rank() != rank) continue;
    for (const std::vector<NodeRun>& runs : in_messages(runs_of(rank))) {
      Message message(runs);
      pass(rank, runs, message);
    }
  }
}

/// Sends a message to a rank or receives one: `start` is MPI_Isend or MPI_Irecv.
template <class Start>
void exchange(const Session& session, Message& message, int rank, const Start& start) {
  MPI_Request request = MPI_REQUEST_NULL;
  check_mpi(start(message.vectors.data(), static_cast<int>(3 * message.vectors.size()), MPI_DOUBLE, rank,
                  state_tag, MPI_COMM_WORLD, &request),
            "exchanging a state");
  session.wait({&request, 1}, std::array{rank});
}

/// Writes the ranks' own nodes into the file of a state of `nodes` nodes: runs_of(rank) gives the nodes of a
/// rank, `own` is the state of this rank's.
template <class RunsOf>
void gather(const Session& session, const std::filesystem::path& file, std::size_t nodes,
            const RunsOf& runs_of, const State& own) {
  std::size_t given = 0;
  std::optional<MappedState> all;
  if (session.rank() == 0) all.emplace(file, nodes);
  for_each_message(session, runs_of, [&](int rank, const std::vector<NodeRun>& runs, Message& message) {
    if (session.rank() == rank) {
      std::copy_n(own.position.data() + given, message.nodes, message.positions());
      std::copy_n(own.velocity.data() + given, message.nodes, message.velocities());
      given += message.nodes;
    } else {
      exchange(session, message, rank, MPI_Irecv);
    }
    if (!all) return exchange(session, message, 0, MPI_Isend);
    for (std::size_t place = 0; const NodeRun& run : runs) {
      std::copy_n(message.positions() + place, run.count, all->position(run.first));
      std::copy_n(message.velocities() + place, run.count, all->velocity(run.first));
      place += run.count;
    }
  });
}

}  // namespace

void Piece::restart(double) { refuse_windows(); }
std::vector<NodeRun> Piece::owned_by(int, const GridWindow&) const { refuse_windows(); }
State Piece::state(const GridWindow&) const { refuse_windows(); }

void require_cut(const SceneSpec& scene, const Integrator& integrator, int ranks) {
  if (const auto* cloth = std::get_if<ClothSpec>(&scene.content))
    require_columns(cloth->columns, integrator, ranks);
  else if (std::holds_alternative<BodiesSpec>(scene.content))
    require_shares(scene, ranks);
}

std::unique_ptr<Piece> make_piece(const Session& session, const RankJob& job) {
  const bool is_cloth = std::holds_alternative<ClothSpec>(job.scene.content);
  const bool has_bodies = std::holds_alternative<BodiesSpec>(job.scene.content);
  if (!is_cloth && !has_bodies) throw Unsupported("it steps only cloths and bodies");
  if (job.copies) return std::make_unique<CopiesPiece>(session, job);
  if (is_cloth) return make_cloth_piece(session, job);
  return make_bodies_piece(session, job);
}

void scatter_state(const Session& session, const std::filesystem::path& file, Piece& piece) {
  State own;
  std::optional<MappedState> all;
  if (session.rank() == 0) all.emplace(file, piece.scene_nodes());
  const auto runs_of = [&](int rank) { return piece.taken_by(rank); };
  for_each_message(session, runs_of, [&](int rank, const std::vector<NodeRun>& runs, Message& message) {
    if (!all)
      exchange(session, message, 0, MPI_Irecv);
    else
      for (std::size_t place = 0; const NodeRun& run : runs) {
        std::copy_n(all->position(run.first), run.count, message.positions() + place);
        std::copy_n(all->velocity(run.first), run.count, message.velocities() + place);
        place += run.count;
      }
    if (session.rank() != rank) return exchange(session, message, rank, MPI_Isend);
    own.position.insert(own.position.end(), message.positions(), message.positions() + message.nodes);
    own.velocity.insert(own.velocity.end(), message.velocities(), message.velocities() + message.nodes);
  });
  piece.set_state(own);
}

void gather_state(const Session& session, const std::filesystem::path& file, const Piece& piece) {
  gather(
      session, file, piece.scene_nodes(), [&](int rank) { return piece.owned_by(rank); }, piece.state());
}

void gather_window(const Session& session, const std::filesystem::path& file, const Piece& piece,
                   const GridWindow& window) {
  gather(
      session, file, window.nodes(), [&](int rank) { return piece.owned_by(rank, window); },
      piece.state(window));
}

void StepCosts::step(const Session& session, Piece& piece, int count) {
  const Stopwatch all;
  piece.step(count);
  const Stopwatch stepped;
  session.meet();
  met_s_ += stepped.seconds();
  const double seconds = all.seconds();
  seconds_ += seconds;
  steps_ += count;
  last_step_s_ = seconds / count;
}

int StepCosts::steps_to_meeting() const {
  constexpr double seconds = 2;
  if (last_step_s_ == 0) return 1;
  return static_cast<int>(std::clamp<double>(seconds / last_step_s_, 1, std::numeric_limits<int>::max()));
}

std::vector<std::string> StepCosts::tell(const Session& session, const Piece& piece) {
  const RankCosts now = piece.costs(), before = std::exchange(told_, now);
  const double seconds = std::exchange(seconds_, 0), met_s = std::exchange(met_s_, 0),
               steps = std::exchange(steps_, 0);
  std::vector<std::string> lines;
  const auto say = [&](const char* name, double value) {
    lines.push_back(fmt::format("cost {} {}", name, decimal(value)));
  };
  double waiting = 0, packing = 0, bytes = 0, messages = 0;
  if (seconds > 0) {
    waiting = (met_s + now.waited_s - before.waited_s) / seconds;
    packing = (now.packed_s - before.packed_s) / seconds;
    bytes = static_cast<double>(now.bytes - before.bytes) / steps;
    messages = static_cast<double>(now.messages - before.messages) / steps;
  }
  double waiting_sum = 0, packing_sum = 0, most_bytes = 0, most_messages = 0;
  const std::string own =
      decimal(waiting) + ' ' + decimal(packing) + ' ' + decimal(bytes) + ' ' + decimal(messages);
  for (const std::string& text : session.gather(own)) {
    std::istringstream of_rank(text);
    of_rank >> waiting >> packing >> bytes >> messages;
    waiting_sum += waiting;
    packing_sum += packing;
    most_bytes = std::max(most_bytes, bytes);
    most_messages = std::max(most_messages, messages);
  }
  say("waiting", std::min(1.0, waiting_sum / session.ranks()));
  say("packing", std::min(1.0, packing_sum / session.ranks()));
  say("bytes", most_bytes);
  say("messages", most_messages);
  if (session.ranks() > 1) {
    say("latency", links_.latency_s);
    say("bandwidth", links_.bytes_per_second);
  }
  return lines;
}

}  // namespace mssim
