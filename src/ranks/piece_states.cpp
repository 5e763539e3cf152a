#include "ranks/piece_states.h"

#include <fcntl.h>
#include <sys/mman.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "platform/descriptor.h"

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

/// Some rows of the columns of a rank, as they travel: for each row its positions, and then its velocities.
struct RowBlock {
  std::size_t row, rows;
  std::vector<Vec3d> vectors;
};

/// Calls `take` with blocks that cover so many rows of so many columns.
template <class Take>
void for_each_block(std::size_t rows, std::size_t columns, const Take& take) {
  const std::size_t at_once = std::max<std::size_t>(1, nodes_at_once / columns);
  for (std::size_t row = 0; row < rows; row += at_once) {
    const std::size_t count = std::min(at_once, rows - row);
    take(RowBlock{row, count, std::vector<Vec3d>(2 * count * columns)});
  }
}

/// Sends a block to, or receives it from, a rank.
void send(const Session& session, RowBlock& block, int rank) {
  MPI_Request request = MPI_REQUEST_NULL;
  check_mpi(MPI_Isend(block.vectors.data(), static_cast<int>(3 * block.vectors.size()), MPI_DOUBLE, rank,
                      state_tag, MPI_COMM_WORLD, &request),
            "sending a state");
  session.wait({&request, 1}, std::array{rank});
}

void receive(const Session& session, RowBlock& block, int rank) {
  MPI_Request request = MPI_REQUEST_NULL;
  check_mpi(MPI_Irecv(block.vectors.data(), static_cast<int>(3 * block.vectors.size()), MPI_DOUBLE, rank,
                      state_tag, MPI_COMM_WORLD, &request),
            "receiving a state");
  session.wait({&request, 1}, std::array{rank});
}

/// Between a block of these columns and arrays whose rows have `pitch` nodes, of which the columns begin at
/// `first`: `copy(in the block, position or velocity there, columns)`.
template <class Position, class Velocity, class Copy>
void copy_rows(RowBlock& block, ColumnRange columns, std::size_t pitch, std::size_t first,
               const Position& position, const Velocity& velocity, const Copy& copy) {
  for (std::size_t r = 0; r < block.rows; ++r) {
    const std::size_t node = (block.row + r) * pitch + first;
    Vec3d* row = block.vectors.data() + 2 * r * columns.count;
    copy(row, position(node), columns.count);
    copy(row + columns.count, velocity(node), columns.count);
  }
}

void into_block(Vec3d* block, const Vec3d* array, std::size_t count) { std::copy_n(array, count, block); }
void from_block(const Vec3d* block, Vec3d* array, std::size_t count) { std::copy_n(block, count, array); }

}  // namespace

void scatter_state(const Session& session, const std::filesystem::path& file, ClothPiece& piece) {
  const ColumnRange here = piece.with_ghosts(session.rank());
  State state;
  state.position.resize(piece.rows() * here.count);
  state.velocity.resize(piece.rows() * here.count);
  const auto keep = [&](RowBlock& block) {
    copy_rows(
        block, here, here.count, 0, [&](std::size_t node) { return &state.position[node]; },
        [&](std::size_t node) { return &state.velocity[node]; }, from_block);
  };
  if (session.rank() == 0) {
    const MappedState all(file, piece.rows() * piece.columns());
    for (int rank = session.ranks() - 1; rank >= 0; --rank) {
      const ColumnRange columns = piece.with_ghosts(rank);
      for_each_block(piece.rows(), columns.count, [&](RowBlock block) {
        copy_rows(
            block, columns, piece.columns(), columns.first,
            [&](std::size_t node) { return all.position(node); },
            [&](std::size_t node) { return all.velocity(node); }, into_block);
        if (rank == 0)
          keep(block);
        else
          send(session, block, rank);
      });
    }
  } else {
    for_each_block(piece.rows(), here.count, [&](RowBlock block) {
      receive(session, block, 0);
      keep(block);
    });
  }
  piece.set_state(state);
}

void gather_state(const Session& session, const std::filesystem::path& file, const ClothPiece& piece) {
  const State state = piece.state();
  const ColumnRange own = piece.columns_of(session.rank()), here = piece.with_ghosts(session.rank());
  const auto fill = [&](RowBlock& block) {
    copy_rows(
        block, own, here.count, own.first - here.first,
        [&](std::size_t node) { return &state.position[node]; },
        [&](std::size_t node) { return &state.velocity[node]; }, into_block);
  };
  if (session.rank() != 0) {
    for_each_block(piece.rows(), own.count, [&](RowBlock block) {
      fill(block);
      send(session, block, 0);
    });
    return;
  }
  const MappedState all(file, piece.rows() * piece.columns());
  for (int rank = 0; rank < session.ranks(); ++rank) {
    const ColumnRange columns = piece.columns_of(rank);
    for_each_block(piece.rows(), columns.count, [&](RowBlock block) {
      if (rank == 0)
        fill(block);
      else
        receive(session, block, rank);
      copy_rows(
          block, columns, piece.columns(), columns.first,
          [&](std::size_t node) { return all.position(node); },
          [&](std::size_t node) { return all.velocity(node); }, from_block);
    });
  }
}

}  // namespace mssim
