#include "ranks/messages.h"

#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>
#include <sstream>
#include <thread>
#include <utility>

#include "backends/interface/backend.h"
#include "ranks/requests.h"
#include "text/text.h"

namespace mssim {
namespace {

using Clock = std::chrono::steady_clock;

std::string host_name() {
  std::array<char, MPI_MAX_PROCESSOR_NAME> name{};
  int length = 0;
  MPI_Get_processor_name(name.data(), &length);
  return {name.data(), static_cast<std::size_t>(length)};
}

bool all_complete(std::span<MPI_Request> requests, const char* action = "waiting for messages") {
  int complete = 0;
  check_mpi(MPI_Testall(static_cast<int>(requests.size()), requests.data(), &complete, MPI_STATUSES_IGNORE),
            action);
  return complete != 0;
}

/// Floats per node in a message.
constexpr std::size_t node_floats = 6;
/// Offset of the velocity in a record (backends/layouts/node_arrays.h).
constexpr std::size_t velocity = 4;

constexpr int link_tag = 3;
constexpr std::size_t few_bytes = 8;
/// About the size of the edge columns of a large cloth's part.
constexpr std::size_t many_bytes = std::size_t{1} << 16;
constexpr int trials = 100;

/// Starts a message to or from a rank: `start` is MPI_Isend or MPI_Irecv.
template <class Start>
MPI_Request started(const Start& start, std::span<char> bytes, int rank) {
  MPI_Request request = MPI_REQUEST_NULL;
  check_mpi(
      start(bytes.data(), static_cast<int>(bytes.size()), MPI_CHAR, rank, link_tag, MPI_COMM_WORLD, &request),
      "measuring a link");
  return request;
}

/// The shortest of all trials: other programs can only add time.
template <class Exchange>
double least_seconds(const Exchange& exchange) {
  double least = std::numeric_limits<double>::infinity();
  for (int trial = 0; trial < trials; ++trial) {
    const Stopwatch watch;
    exchange();
    least = std::min(least, watch.seconds());
  }
  return least;
}

/// Half of the time of a message to a rank and back: each sends after receiving.
double one_way_s(const Session& session, int rank) {
  std::array<char, few_bytes> bytes{};
  const auto pass = [&](auto start) {
    MPI_Request request = started(start, bytes, rank);
    session.wait({&request, 1}, std::array{rank});
  };
  return least_seconds([&] {
           if (session.rank() < rank) pass(MPI_Isend);
           pass(MPI_Irecv);
           if (session.rank() > rank) pass(MPI_Isend);
         }) /
         2;
}

/// Time if both send simultaneously.
double both_ways_s(const Session& session, int rank) {
  std::vector<char> sent(many_bytes), received(many_bytes);
  return least_seconds([&] {
    std::array requests{started(MPI_Irecv, received, rank), started(MPI_Isend, sent, rank)};
    session.wait(requests, std::array{rank});
  });
}

}  // namespace

void check_mpi(int result, const char* action) {
  if (result == MPI_SUCCESS) return;
  std::array<char, MPI_MAX_ERROR_STRING> text{};
  int length = 0;
  MPI_Error_string(result, text.data(), &length);
  throw RankFailure(
      fmt::format("{} failed: {}", action, std::string(text.data(), static_cast<std::size_t>(length))));
}

Session::Session(int* argc, char*** argv) {
  // Open MPI (4 and 5) leaves 4 MB of shared memory behind for each killed rank: in a folder that mssim
  // removes, if it is in this machine's shared memory.
  if (const std::string folder = variable("MSSIM_MEMORY_FOLDER");
      folder.starts_with("/dev/shm/") && ::access(folder.c_str(), W_OK) == 0)
    for (const char* name : {"OMPI_MCA_btl_vader_backing_directory", "OMPI_MCA_btl_sm_backing_directory"})
      ::setenv(name, folder.c_str(), 0);
  int provided = 0;
  // A rank's threads call MPI one at a time, but not always the same thread.
  if (MPI_Init_thread(argc, argv, MPI_THREAD_SERIALIZED, &provided) != MPI_SUCCESS)
    throw RankFailure("MPI did not start");
  if (provided < MPI_THREAD_SERIALIZED)
    throw RankFailure("this MPI cannot be called by several threads of a process");
  MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
  int count = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &count);
  hosts_.resize(static_cast<std::size_t>(count));
  hosts_ = gather(host_name());
  const std::string& own = hosts_[static_cast<std::size_t>(rank_)];
  ranks_on_host_ = static_cast<int>(std::ranges::count(hosts_, own));
}

Session::~Session() {
  if (std::uncaught_exceptions() == 0) MPI_Finalize();
}

std::string Session::name_of(int rank) const {
  return fmt::format("rank {} on {}", rank, hosts_[static_cast<std::size_t>(rank)]);
}

void Session::give_up(const std::string& sentence) const {
  // One write: other ranks may print at the same time.
  std::cerr << std::string(sentence_mark) + name_of(rank_) + ": " + sentence + '\n' << std::flush;
  MPI_Abort(MPI_COMM_WORLD, 1);
  std::abort();
}

std::vector<int> Session::others() const {
  std::vector<int> all(static_cast<std::size_t>(ranks()));
  std::iota(all.begin(), all.end(), 0);
  std::erase(all, rank_);
  return all;
}

void Session::wait(std::span<MPI_Request> requests, std::span<const int> peers) const {
  constexpr int tests_a_look = 256;  // iterations between two readings of the clock
  std::optional<Clock::time_point> begin;
  for (;;) {
    for (int test = 0; test < tests_a_look; ++test) {
      if (all_complete(requests)) return;
      if (shares_) ::sched_yield();
    }
    const Clock::time_point now = Clock::now();
    if (!begin) begin = now;
    if (now - *begin < std::chrono::duration<double>(longest_wait_s_)) continue;
    std::vector<std::string> silent;
    for (const int peer : peers) add_once(silent, name_of(peer));
    throw RankFailure(fmt::format("it has received nothing for {} from {}",
                                  pluralize(static_cast<std::uint64_t>(longest_wait_s_), "second"),
                                  listed(silent, "or")));
  }
}

void Session::wait_idle(MPI_Request& request) {
  using namespace std::chrono_literals;
  const Clock::time_point begin = Clock::now();
  // Poll first, because the next request often comes at once; during a long wait, leave the CPU to others.
  while (!all_complete({&request, 1}))
    if (Clock::now() - begin > 2ms)
      std::this_thread::sleep_for(50us);
    else
      ::sched_yield();
}

void Session::meet() const {
  MPI_Request request = MPI_REQUEST_NULL;
  check_mpi(MPI_Ibarrier(MPI_COMM_WORLD, &request), "meeting");
  wait({&request, 1}, others());
}

std::string Session::share(std::string text) const {
  MPI_Request request = MPI_REQUEST_NULL;
  auto bytes = static_cast<int>(text.size());
  check_mpi(MPI_Ibcast(&bytes, 1, MPI_INT, 0, MPI_COMM_WORLD, &request), "sharing a text");
  wait({&request, 1}, std::array{0});
  text.resize(static_cast<std::size_t>(bytes));
  check_mpi(MPI_Ibcast(text.data(), bytes, MPI_CHAR, 0, MPI_COMM_WORLD, &request), "sharing a text");
  wait({&request, 1}, std::array{0});
  return text;
}

std::vector<std::string> Session::gather(const std::string& text) const {
  const auto bytes = static_cast<int>(text.size());
  std::vector<int> lengths(hosts_.size()), begins;
  MPI_Request request = MPI_REQUEST_NULL;
  const auto complete = [&](int begun) {
    check_mpi(begun, "gathering texts");
    wait({&request, 1}, others());
  };
  complete(MPI_Iallgather(&bytes, 1, MPI_INT, lengths.data(), 1, MPI_INT, MPI_COMM_WORLD, &request));
  std::exclusive_scan(lengths.begin(), lengths.end(), std::back_inserter(begins), 0);
  std::string all(static_cast<std::size_t>(begins.back() + lengths.back()), '\0');
  complete(MPI_Iallgatherv(text.data(), bytes, MPI_CHAR, all.data(), lengths.data(), begins.data(), MPI_CHAR,
                           MPI_COMM_WORLD, &request));
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < lengths.size(); ++i)
    texts.push_back(all.substr(static_cast<std::size_t>(begins[i]), static_cast<std::size_t>(lengths[i])));
  return texts;
}

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
  attempt([&] { under_way_ = !all_complete(requests_, "advancing messages"); });
}

void StandingMessages::finish() {
  if (!std::exchange(under_way_, false)) return;
  const SecondsAdded timed(costs_.waited_s);
  attempt([&] { session_.wait(requests_, peers_); });
}

void add_edge_columns(StandingMessages& messages, int rank, BandGrid& bands) {
  const std::size_t ghosts = ghost_columns(*bands.integrator, bands.steps_per_pass);
  const std::size_t floats = ghosts * bands.layout.column_floats();
  const ColumnRange own = bands.own;
  const auto columns = [&](BandPartition& partition, std::size_t first) {
    return std::span(partition.column(bands.layout, Pair::state, first), floats);
  };
  BandPartition &first = bands.partitions.front(), &last = bands.partitions.back();
  if (own.first > 0) messages.add(rank - 1, columns(first, own.first), columns(first, own.first - ghosts));
  if (own.end() < bands.layout.columns)
    messages.add(rank + 1, columns(last, own.end() - ghosts), columns(last, own.end()));
}

GhostMessages::GhostMessages(const Session& session, const BodiesPart& part, const SlicedBodies& bodies)
    : first_ghost_slot_(bodies.slices() * bodies.lanes), messages_(session) {
  for (const BodiesPart::Neighbour& neighbour : part.neighbours)
    for (const std::uint32_t node : neighbour.edge) edge_slots_.push_back(bodies.slot[node]);
  sent_.resize(edge_slots_.size() * node_floats);
  received_.resize((part.system.nodes() - part.graph.own) * node_floats);
  std::span<const float> sent = sent_;
  std::span<float> received = received_;
  for (const BodiesPart::Neighbour& neighbour : part.neighbours) {
    const std::size_t sends = neighbour.edge.size() * node_floats, takes = neighbour.ghosts * node_floats;
    messages_.add(neighbour.rank, sent.first(sends), received.first(takes));
    sent = sent.subspan(sends);
    received = received.subspan(takes);
  }
}

RankCosts GhostMessages::costs() const {
  RankCosts costs = messages_.costs();
  costs.packed_s += packed_s_;
  return costs;
}

void GhostMessages::begin(const float* records) {
  {
    const SecondsAdded timed(packed_s_);
    float* to = sent_.data();
    for (const std::uint32_t slot : edge_slots_) {
      const float* record = records + std::size_t{slot} * record_floats;
      to = std::copy_n(record, 3, to);
      to = std::copy_n(record + velocity, 3, to);
    }
  }
  messages_.begin();
}

void GhostMessages::finish(float* records) {
  messages_.finish();
  const SecondsAdded timed(packed_s_);
  float* record = records + first_ghost_slot_ * record_floats;
  for (std::size_t i = 0; i < received_.size(); i += node_floats, record += record_floats) {
    std::copy_n(received_.data() + i, 3, record);
    std::copy_n(received_.data() + i + 3, 3, record + velocity);
  }
}

void require_memory(const Session& session, std::uint64_t bytes) {
  const auto here = static_cast<std::uint64_t>(session.ranks_on_host());
  std::string sentence;
  if (const auto shortage = memory_shortage(here * bytes))
    sentence = session.name_of(session.rank()) + (here > 1 ? " with the others there " : " ") + *shortage +
               ": take more machines, or make the scene smaller";
  for (const std::string& other : session.gather(sentence))
    if (!other.empty()) throw Unavailable(other);
}

LinkSpeed measure_links(const Session& session) {
  if (session.ranks() == 1) return {};
  double one_way = 0, both_ways = 0;
  for (int first = 0; first < 2; ++first) {
    session.meet();
    const bool is_left = (session.rank() - first) % 2 == 0;
    const int rank = session.rank() + (is_left ? 1 : -1);
    if (rank < 0 || rank >= session.ranks()) continue;
    one_way = std::max(one_way, one_way_s(session, rank));
    both_ways = std::max(both_ways, both_ways_s(session, rank));
  }
  for (const std::string& other : session.gather(decimal(one_way) + ' ' + decimal(both_ways))) {
    std::istringstream of_rank(other);
    double latency = 0, seconds = 0;
    of_rank >> latency >> seconds;
    one_way = std::max(one_way, latency);
    both_ways = std::max(both_ways, seconds);
  }
  return {one_way, static_cast<double>(many_bytes) / both_ways};
}

}  // namespace mssim
