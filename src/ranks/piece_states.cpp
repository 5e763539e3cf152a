#include "ranks/piece_states.h"

#include <fcntl.h>
#include <sys/mman.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "platform/process.h"

namespace mssim {
namespace {

/// Nodes that a message holds at most.
constexpr std::size_t nodes_at_once = std::size_t{1} << 18;
constexpr int state_tag = 2;

/// The file of a state, [2: positions, velocities][nodes] vectors, in memory. mssim, which made it, leaves
/// its size alone.
class MappedState {
 public:
  MappedState(const std::filesystem::path& file, std::size_t nodes) : nodes_(nodes) {
    const Descriptor open(::open(file.c_str(), O_RDWR | O_CLOEXEC));
    void* memory = open.is_open()
                       ? ::mmap(nullptr, bytes(), PROT_READ | PROT_WRITE, MAP_SHARED, open.get(), 0)
                       : MAP_FAILED;
    if (memory == MAP_FAILED)
      throw RankFailure("rank 0 cannot open " + file.string() + " (" + std::strerror(errno) +
                        "): it must run on the machine of mssim");
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

/// Goes through the nodes of some runs.
class NodeWalk {
 public:
  explicit NodeWalk(std::vector<NodeRun> runs) : runs_(std::move(runs)) {}
  /// The next nodes, as many as a message holds; none at the end.
  std::vector<NodeRun> next() {
    std::vector<NodeRun> some;
    std::size_t room = nodes_at_once;
    while (room > 0 && run_ < runs_.size()) {
      const NodeRun run = runs_[run_];
      const std::size_t count = std::min(room, run.count - taken_);
      some.push_back({run.first + taken_, count});
      room -= count;
      taken_ += count;
      if (taken_ == run.count) {
        ++run_;
        taken_ = 0;
      }
    }
    return some;
  }

 private:
  std::vector<NodeRun> runs_;
  std::size_t run_ = 0, taken_ = 0;
};

/// The states of some nodes on their way: all positions, and then all velocities.
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

/// Calls `take` with every run of a message and its place there.
template <class Take>
void for_each_run(const std::vector<NodeRun>& runs, const Take& take) {
  std::size_t place = 0;
  for (const NodeRun& run : runs) {
    take(run, place);
    place += run.count;
  }
}

/// Calls `pass` for every message between rank 0 and a rank in which this process has a part: the rank, the
/// runs and the message.
template <class RunsOf, class Pass>
void for_each_message(const Session& session, const RunsOf& runs_of, const Pass& pass) {
  for (int rank = 0; rank < session.ranks(); ++rank) {
    if (session.rank() != 0 && session.rank() != rank) continue;
    NodeWalk walk(runs_of(rank));
    for (std::vector<NodeRun> runs = walk.next(); !runs.empty(); runs = walk.next()) {
      Message message(runs);
      pass(rank, runs, message);
    }
  }
}

/// Sends a message to a rank, or receives it from there: `start` is MPI_Isend or MPI_Irecv.
template <class Start>
void exchange(const Session& session, Message& message, int rank, const Start& start) {
  MPI_Request request = MPI_REQUEST_NULL;
  check_mpi(start(message.vectors.data(), static_cast<int>(3 * message.vectors.size()), MPI_DOUBLE, rank,
                  state_tag, MPI_COMM_WORLD, &request),
            "exchanging a state");
  session.wait({&request, 1}, std::array{rank});
}

/// Writes what the ranks own of the nodes of a file into it: runs_of(rank), whose state on this rank is
/// `own`.
template <class RunsOf>
void gather(const Session& session, const std::filesystem::path& file, std::size_t nodes,
            const RunsOf& runs_of, const State& own) {
  std::size_t given = 0;
  const auto fill = [&](Message& message) {
    std::copy_n(own.position.data() + given, message.nodes, message.positions());
    std::copy_n(own.velocity.data() + given, message.nodes, message.velocities());
    given += message.nodes;
  };
  std::optional<MappedState> all;
  if (session.rank() == 0) all.emplace(file, nodes);
  for_each_message(session, runs_of, [&](int rank, const std::vector<NodeRun>& runs, Message& message) {
    if (session.rank() == rank)
      fill(message);
    else
      exchange(session, message, rank, MPI_Irecv);
    if (all)
      for_each_run(runs, [&](const NodeRun& run, std::size_t place) {
        std::copy_n(message.positions() + place, run.count, all->position(run.first));
        std::copy_n(message.velocities() + place, run.count, all->velocity(run.first));
      });
    else
      exchange(session, message, 0, MPI_Isend);
  });
}

}  // namespace

void scatter_state(const Session& session, const std::filesystem::path& file, Piece& piece) {
  State own;
  const auto keep = [&](Message& message) {
    own.position.insert(own.position.end(), message.positions(), message.positions() + message.nodes);
    own.velocity.insert(own.velocity.end(), message.velocities(), message.velocities() + message.nodes);
  };
  std::optional<MappedState> all;
  if (session.rank() == 0) all.emplace(file, piece.scene_nodes());
  const auto runs_of = [&](int rank) { return piece.taken_by(rank); };
  for_each_message(session, runs_of, [&](int rank, const std::vector<NodeRun>& runs, Message& message) {
    if (all)
      for_each_run(runs, [&](const NodeRun& run, std::size_t place) {
        std::copy_n(all->position(run.first), run.count, message.positions() + place);
        std::copy_n(all->velocity(run.first), run.count, message.velocities() + place);
      });
    else
      exchange(session, message, 0, MPI_Irecv);
    if (session.rank() == rank)
      keep(message);
    else
      exchange(session, message, rank, MPI_Isend);
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

}  // namespace mssim
