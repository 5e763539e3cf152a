#include "ranks/neighbour_messages.h"

#include <chrono>
#include <utility>

namespace mssim {

NeighbourMessages::NeighbourMessages(const Session& session, BandGrid& bands) : session_(session) {
  const std::size_t ghosts = ghost_columns(*bands.integrator, bands.steps_per_pass);
  const std::size_t floats = ghosts * bands.layout.column_floats();
  const ColumnRange own = bands.own;
  const auto column = [&](BandPartition& partition, std::size_t c) {
    return partition.column(bands.layout, Pair::state, c);
  };
  BandPartition &first = bands.partitions.front(), &last = bands.partitions.back();
  if (own.first > 0)
    add(session.rank() - 1, column(first, own.first), column(first, own.first - ghosts), floats);
  if (own.end() < bands.layout.columns)
    add(session.rank() + 1, column(last, own.end() - ghosts), column(last, own.end()), floats);
}

void NeighbourMessages::add(int neighbour, const float* own, float* ghosts, std::size_t floats) {
  constexpr int tag = 1;
  const auto count = static_cast<int>(floats);
  MPI_Request& receives = requests_.emplace_back();
  check_mpi(MPI_Recv_init(ghosts, count, MPI_FLOAT, neighbour, tag, MPI_COMM_WORLD, &receives),
            "preparing messages");
  MPI_Request& sends = requests_.emplace_back();
  check_mpi(MPI_Send_init(own, count, MPI_FLOAT, neighbour, tag, MPI_COMM_WORLD, &sends),
            "preparing messages");
  peers_.push_back(neighbour);
  bytes_a_pass_ += floats * sizeof(float);
}

template <class Work>
void NeighbourMessages::attempt(const Work& work) const {
  try {
    work();
  } catch (const RankFailure& failure) {
    session_.give_up(failure.what());
  }
}

NeighbourMessages::~NeighbourMessages() {
  for (MPI_Request& request : requests_) MPI_Request_free(&request);
}

void NeighbourMessages::begin() {
  attempt([&] {
    check_mpi(MPI_Startall(static_cast<int>(requests_.size()), requests_.data()), "starting messages");
  });
  costs_.bytes += bytes_a_pass_;
  costs_.messages += requests_.size() / 2;
  under_way_ = true;
}

void NeighbourMessages::advance() {
  if (!under_way_) return;
  int complete = 0;
  attempt([&] {
    check_mpi(
        MPI_Testall(static_cast<int>(requests_.size()), requests_.data(), &complete, MPI_STATUSES_IGNORE),
        "advancing messages");
  });
  under_way_ = complete == 0;
}

void NeighbourMessages::finish() {
  if (!std::exchange(under_way_, false)) return;
  const auto begin = std::chrono::steady_clock::now();
  attempt([&] { session_.wait(requests_, peers_); });
  costs_.waited_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace mssim
