#include "ranks/session.h"

#include <sched.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <iterator>
#include <numeric>
#include <optional>
#include <thread>

#include "ranks/launch_words.h"
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

bool all_complete(std::span<MPI_Request> requests) {
  int complete = 0;
  check_mpi(MPI_Testall(static_cast<int>(requests.size()), requests.data(), &complete, MPI_STATUSES_IGNORE),
            "waiting for messages");
  return complete != 0;
}

}  // namespace

void check_mpi(int result, const char* action) {
  if (result == MPI_SUCCESS) return;
  std::array<char, MPI_MAX_ERROR_STRING> text{};
  int length = 0;
  MPI_Error_string(result, text.data(), &length);
  throw RankFailure(std::string(action) +
                    " failed: " + std::string(text.data(), static_cast<std::size_t>(length)));
}

Session::Session(int* argc, char*** argv) {
  int provided = 0;
  // One thread of a rank calls MPI at a time, but not always the same one.
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
  rank_on_host_ = static_cast<int>(std::count(hosts_.begin(), hosts_.begin() + rank_, own));
}

Session::~Session() {
  if (std::uncaught_exceptions() == 0) MPI_Finalize();
}

std::string Session::name_of(int rank) const {
  return "rank " + std::to_string(rank) + " on " + hosts_[static_cast<std::size_t>(rank)];
}

void Session::give_up(const std::string& sentence) const {
  // In one piece: other ranks may say something at the same time.
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
  constexpr int tests_a_look = 256;  // at the clock
  std::optional<Clock::time_point> begin;
  for (;;) {
    for (int test = 0; test < tests_a_look; ++test) {
      if (all_complete(requests)) return;
      if (shares_) ::sched_yield();
    }
    const Clock::time_point now = Clock::now();
    if (!begin) begin = now;
    if (now - *begin < std::chrono::duration<double>(longest_silence_s)) continue;
    std::vector<std::string> silent;
    for (const int peer : peers)
      if (std::ranges::find(silent, name_of(peer)) == silent.end()) silent.push_back(name_of(peer));
    throw RankFailure("it has heard nothing for " +
                      pluralize(static_cast<std::uint64_t>(longest_silence_s), "second") + " from " +
                      listed(silent, "or"));
  }
}

void Session::wait_idle(MPI_Request& request) {
  using namespace std::chrono_literals;
  const Clock::time_point begin = Clock::now();
  // What follows a request at once is not kept waiting; who waits long leaves the processor to others.
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

}  // namespace mssim
