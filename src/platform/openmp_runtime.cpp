#include "platform/openmp_runtime.h"

#include <omp.h>
#include <pthread.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <chrono>
#include <cstdlib>
#include <deque>
#include <filesystem>
#include <mutex>
#include <string_view>
#include <system_error>
#include <thread>

#include "text/counted.h"

namespace mssim {
namespace {

constexpr const char* spin_variable = "GOMP_SPINCOUNT";
/// Some ten or hundred microseconds, as long as a pause takes on the processor. Nobody but this program
/// writes a sign before it, by which it knows that it has started itself.
constexpr std::string_view short_spins = "+1000";

/// OMP_STACKSIZE as libgomp reads it, in bytes; none where it is not set, or is no size.
std::optional<std::size_t> openmp_stack_bytes() {
  const char* text = std::getenv("OMP_STACKSIZE");
  if (text == nullptr) text = std::getenv("GOMP_STACKSIZE");
  if (text == nullptr) return std::nullopt;
  char* end = nullptr;
  const std::uint64_t number = std::strtoull(text, &end, 10);
  if (end == text) return std::nullopt;
  while (std::isspace(static_cast<unsigned char>(*end)) != 0) ++end;
  constexpr std::string_view units = "bkmg";
  const auto unit = *end == '\0' ? 1 : units.find(static_cast<char>(std::tolower(*end)));
  if (unit == std::string_view::npos) return std::nullopt;
  return static_cast<std::size_t>(number << (10 * unit));
}

/// A thread that waits until it may end.
struct Waiter {
  pthread_t handle{};
  std::atomic<bool>* may_end = nullptr;
  pid_t number = 0;  // of the system; known when it has ended

  static void* run(void* argument) {
    auto& self = *static_cast<Waiter*>(argument);
    self.number = gettid();
    self.may_end->wait(false);
    return nullptr;
  }
  /// The system counts a thread for a moment longer than until others can see that it has ended.
  void end_and_leave() const {
    pthread_join(handle, nullptr);
    const std::string folder = "/proc/self/task/" + std::to_string(number);
    const auto latest = std::chrono::steady_clock::now() + std::chrono::seconds(1);
    while (access(folder.c_str(), F_OK) == 0 && std::chrono::steady_clock::now() < latest)
      std::this_thread::yield();
  }
};

struct Trial {
  int made = 1;  ///< threads at once, with the calling one
  int error = 0;
};

Trial make_threads(int wanted, ThreadStack stack) {
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  // A size that is refused is not taken by libgomp either.
  if (const auto bytes = openmp_stack_bytes(); stack == ThreadStack::openmp && bytes)
    pthread_attr_setstacksize(&attributes, *bytes);
  std::atomic<bool> may_end{false};
  std::deque<Waiter> waiters;
  Trial trial;
  while (trial.made < wanted) {
    Waiter& waiter = waiters.emplace_back();
    waiter.may_end = &may_end;
    trial.error = pthread_create(&waiter.handle, &attributes, &Waiter::run, &waiter);
    if (trial.error != 0) {
      waiters.pop_back();
      break;
    }
    ++trial.made;
  }
  pthread_attr_destroy(&attributes);
  may_end.store(true);
  may_end.notify_all();
  for (const Waiter& waiter : waiters) waiter.end_and_leave();
  return trial;
}

Trial try_threads(int wanted, ThreadStack stack) {
  static std::mutex one_at_a_time;  // trials would count each other's threads
  static int openmp_has_made = 1;
  const std::lock_guard lock(one_at_a_time);
  if (stack == ThreadStack::openmp && wanted <= openmp_has_made) return {wanted};
  const Trial trial = make_threads(wanted, stack);
  if (stack == ThreadStack::openmp) openmp_has_made = std::max(openmp_has_made, trial.made);
  return trial;
}

}  // namespace

void start_with_short_waits(char** argv) {
  const char* spins = std::getenv(spin_variable);
  if (spins != nullptr && spins == short_spins) {
    unsetenv(spin_variable);
    return;
  }
  if (spins != nullptr || std::getenv("OMP_WAIT_POLICY") != nullptr) return;
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error || setenv(spin_variable, short_spins.data(), 1) != 0) return;
  execv(program.c_str(), argv);
  unsetenv(spin_variable);
}

std::optional<std::string> thread_shortage(int threads, ThreadStack stack) {
  const Trial trial = try_threads(threads, stack);
  if (trial.made >= threads) return std::nullopt;
  const char* size = std::getenv("OMP_STACKSIZE");
  return counted(static_cast<std::uint64_t>(threads), "thread") + " were asked for; the system makes " +
         std::to_string(trial.made) + " (" + std::generic_category().message(trial.error) +
         "): ask for fewer with --threads, raise the limit of processes (ulimit -u, or pids.max of a "
         "container)" +
         (stack == ThreadStack::openmp && size ? ", or lower OMP_STACKSIZE, which is " + std::string(size)
                                               : "");
}

int openmp_team(int wanted) {
  const int threads = wanted > 0 ? wanted : omp_get_max_threads();
  return std::min(threads, try_threads(threads, ThreadStack::openmp).made);
}

}  // namespace mssim
