#include "ranks/standing_messages.h"

#include <utility>

namespace mssim {

StandingMessages::~StandingMessages() {
  for (MPI_Request& request : requests_) MPI_Request_free(&request);
}

void StandingMessages::add(int rank, std::span<const float> sent, std::span<float> received) {
  constexpr int tag = 1;
  MPI_Request& receives = requests_.emplace_back();
  check_mpi(MPI_Recv_init(received.data(), static_cast<int>(received.size()), MPI_FLOAT, rank, tag,
                          MPI_COMM_WORLD, &receives),
            "preparing messages");
  MPI_Request& sends = requests_.emplace_back();
  check_mpi(
      MPI_Send_init(sent.data(), static_cast<int>(sent.size()), MPI_FLOAT, rank, tag, MPI_COMM_WORLD, &sends),
      "preparing messages");
  peers_.push_back(rank);
  bytes_ += sent.size_bytes();
}

template <class Work>
void StandingMessages::attempt(const Work& work) const {
  try {
    work();
  } catch (const RankFailure& failure) {
    session_.give_up(failure.what());
  }
}

void StandingMessages::begin() {
  const SecondsAdded timed(costs_.packed_s);
  attempt([&] {
    check_mpi(MPI_Startall(static_cast<int>(requests_.size()), requests_.data()), "starting messages");
  });
  costs_.bytes += bytes_;
  costs_.messages += requests_.size() / 2;
  under_way_ = true;
}

void StandingMessages::advance() {
  if (!under_way_) return;
  const SecondsAdded timed(costs_.packed_s);
  int complete = 0;
  attempt([&] {
    check_mpi(
        MPI_Testall(static_cast<int>(requests_.size()), requests_.data(), &complete, MPI_STATUSES_IGNORE),
        "advancing messages");
  });
  under_way_ = complete == 0;
}

void StandingMessages::finish() {
  if (!std::exchange(under_way_, false)) return;
  const SecondsAdded timed(costs_.waited_s);
  attempt([&] { session_.wait(requests_, peers_); });
}

}  // namespace mssim
