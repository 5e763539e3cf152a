#include "ranks/link_speed.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "text/text.h"

namespace mssim {
namespace {

constexpr int link_tag = 3;
constexpr std::size_t few_bytes = 8;
/// As large as the columns beside a part of a large cloth.
constexpr std::size_t many_bytes = std::size_t{1} << 16;
constexpr int trials = 100;

/// Messages to another rank and from there. Of all trials the shortest counts: other programs only ever add
/// to a time.
class Partner {
 public:
  Partner(const Session& session, int rank) : session_(session), rank_(rank) {}

  /// Half of there and back: one sends when the other has received.
  double one_way_s() {
    std::array<char, few_bytes> bytes{};
    return least_seconds([&] {
             if (session_.rank() < rank_) send(bytes);
             receive(bytes);
             if (session_.rank() > rank_) send(bytes);
           }) /
           2;
  }

  /// Both send at the same time.
  double both_ways_s() {
    std::vector<char> sent(many_bytes), received(many_bytes);
    return least_seconds([&] {
      std::array<MPI_Request, 2> requests{MPI_REQUEST_NULL, MPI_REQUEST_NULL};
      check_mpi(MPI_Irecv(received.data(), static_cast<int>(many_bytes), MPI_CHAR, rank_, link_tag,
                          MPI_COMM_WORLD, &requests[0]),
                "measuring a link");
      check_mpi(MPI_Isend(sent.data(), static_cast<int>(many_bytes), MPI_CHAR, rank_, link_tag,
                          MPI_COMM_WORLD, &requests[1]),
                "measuring a link");
      session_.wait(requests, std::array{rank_});
    });
  }

 private:
  template <class Exchange>
  double least_seconds(const Exchange& exchange) {
    double least = std::numeric_limits<double>::infinity();
    for (int trial = 0; trial < trials; ++trial) {
      const auto begin = std::chrono::steady_clock::now();
      exchange();
      least =
          std::min(least, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    }
    return least;
  }

  void send(std::array<char, few_bytes>& bytes) {
    MPI_Request request = MPI_REQUEST_NULL;
    check_mpi(MPI_Isend(bytes.data(), few_bytes, MPI_CHAR, rank_, link_tag, MPI_COMM_WORLD, &request),
              "measuring a link");
    session_.wait({&request, 1}, std::array{rank_});
  }
  void receive(std::array<char, few_bytes>& bytes) {
    MPI_Request request = MPI_REQUEST_NULL;
    check_mpi(MPI_Irecv(bytes.data(), few_bytes, MPI_CHAR, rank_, link_tag, MPI_COMM_WORLD, &request),
              "measuring a link");
    session_.wait({&request, 1}, std::array{rank_});
  }

  const Session& session_;
  int rank_;
};

}  // namespace

LinkSpeed measure_links(const Session& session) {
  if (session.ranks() == 1) return {};
  double latency_s = 0, both_ways_s = 0;
  for (int first = 0; first < 2; ++first) {
    session.meet();
    const bool is_left = (session.rank() - first) % 2 == 0;
    const int rank = session.rank() + (is_left ? 1 : -1);
    if (rank < 0 || rank >= session.ranks()) continue;
    Partner partner(session, rank);
    latency_s = std::max(latency_s, partner.one_way_s());
    both_ways_s = std::max(both_ways_s, partner.both_ways_s());
  }
  for (const std::string& other : session.gather(decimal(latency_s) + ' ' + decimal(both_ways_s))) {
    std::istringstream of_rank(other);
    double latency = 0, seconds = 0;
    of_rank >> latency >> seconds;
    latency_s = std::max(latency_s, latency);
    both_ways_s = std::max(both_ways_s, seconds);
  }
  return {latency_s, static_cast<double>(many_bytes) / both_ways_s};
}

}  // namespace mssim
