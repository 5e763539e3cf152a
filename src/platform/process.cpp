#include "platform/process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstring>
#include <deque>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "platform/files.h"
#include "platform/machine.h"
#include "text/text.h"

namespace mssim {
namespace {

[[noreturn]] void fail(const ChildProcess& child, const std::string& why) {
  throw MissingProgram("cannot run {}: {}", child.program.string(), why);
}

[[noreturn]] void fail(const ChildProcess& child, const std::string& action, int error) {
  fail(child, fmt::format("{} failed ({})", action, std::strerror(error)));
}

/// The two ends of a pipe; a child inherits them only as stdout and stderr.
struct Pipe {
  explicit Pipe(const ChildProcess& child) {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) fail(child, "opening a pipe", errno);
    reader = Descriptor(ends[0]);
    writer = Descriptor(ends[1]);
  }
  Descriptor reader, writer;
};

std::vector<std::string> environment_with(const std::vector<std::string>& added) {
  std::vector<std::string> all = added;
  for (char** entry = environ; entry && *entry; ++entry) {
    const std::string_view text = *entry;
    const std::string_view name_and_equals = text.substr(0, text.find('=') + 1);
    bool replaced = false;
    for (const std::string& own : added) replaced = replaced || own.starts_with(name_and_equals);
    if (!replaced) all.emplace_back(text);
  }
  return all;
}

void limit(int resource, rlim_t soft, rlim_t hard) {
  const rlimit limits{soft, hard};
  // A lower limit already in force may not be raised; then it stays, which also works.
  ::setrlimit(static_cast<__rlimit_resource>(resource), &limits);
}

/// An action that failed in a child before exec: its text, shared with the parent, and errno.
struct StartError {
  const char* action = nullptr;
  int error = 0;
};

/// The last action; the reason for its failure can be explained.
constexpr const char* execution = "starting it";

/// Runs in the child between fork and exec, where only async-signal-safe calls are allowed, because this
/// process may have threads. `group`: a process group, 0 for a new one. Returns only on failure.
StartError become(const ChildProcess& child, char* const* arguments, char* const* environment, int output,
                  pid_t group) {
  // In a group of its own, so that its descendants can be killed with it; it dies with this process, even if
  // that is killed.
  if (::setpgid(0, group) != 0 || ::prctl(PR_SET_PDEATHSIG, SIGKILL) != 0)
    return {"setting its process group", errno};
  const int nothing = ::open("/dev/null", O_RDONLY);
  if (nothing < 0 || ::dup2(nothing, STDIN_FILENO) < 0) return {"opening /dev/null", errno};
  if (::dup2(output, STDOUT_FILENO) < 0 || ::dup2(output, STDERR_FILENO) < 0)
    return {"redirecting its output", errno};
  if (child.cpu_seconds > 0) limit(RLIMIT_CPU, child.cpu_seconds, child.cpu_seconds + 1);
  limit(RLIMIT_CORE, 0, 0);
  if (child.memory_bytes > 0) limit(RLIMIT_AS, child.memory_bytes, child.memory_bytes);
  std::signal(SIGXFSZ, SIG_DFL);  // mssim itself ignores it
  if (::chdir(child.folder.c_str()) != 0) return {"entering its folder", errno};
  ::execve(child.program.c_str(), arguments, environment);
  return {execution, errno};
}

using Clock = std::chrono::steady_clock;

/// Time until the deadline; without one, a year.
std::chrono::milliseconds time_until(const std::optional<Clock::time_point>& deadline) {
  return deadline ? std::chrono::ceil<std::chrono::milliseconds>(*deadline - Clock::now())
                  : std::chrono::hours(24 * 365);
}

/// Reads to the end, at most until the deadline, and keeps the last bytes.
std::string read_tail(int descriptor, const std::optional<Clock::time_point>& deadline) {
  constexpr std::size_t kept = 64 * 1024;
  std::string tail;
  std::array<char, 4096> buffer;
  for (auto left = time_until(deadline); left.count() > 0 && is_readable(descriptor, left);
       left = time_until(deadline)) {
    const ssize_t bytes = ::read(descriptor, buffer.data(), buffer.size());
    if (bytes < 0 && errno == EINTR) continue;
    if (bytes <= 0) break;
    tail.append(buffer.data(), static_cast<std::size_t>(bytes));
    if (tail.size() > 2 * kept) tail.erase(0, tail.size() - kept);
  }
  if (tail.size() > kept) tail.erase(0, tail.size() - kept);
  return tail;
}

/// A running program.
class Running {
 public:
  /// Starts it in process group `group`; 0: in a new group, whose number is its process id.
  Running(const ChildProcess& child, pid_t group) : child_(child), output_(child), start_error_(child) {
    std::vector<std::string> arguments{child.program.filename().string()};
    arguments.insert(arguments.end(), child.arguments.begin(), child.arguments.end());
    std::vector<std::string> environment = environment_with(child.environment);
    const std::vector<char*> argument_pointers = argv_of(arguments);
    const std::vector<char*> environment_pointers = argv_of(environment);
    process_ = ::fork();
    if (process_ < 0) fail(child, "fork", errno);
    if (process_ == 0) {
      const StartError error =
          become(child, argument_pointers.data(), environment_pointers.data(), output_.writer.get(), group);
      [[maybe_unused]] const ssize_t written = ::write(start_error_.writer.get(), &error, sizeof error);
      ::_exit(127);
    }
    // Here as well, so that the group exists before it is watched.
    group_ = group == 0 ? process_ : group;
    ::setpgid(process_, group_);
    if (child.elapsed_seconds > 0) deadline_ = Clock::now() + std::chrono::seconds(child.elapsed_seconds);
    output_.writer.close();
    start_error_.writer.close();
  }

  /// Kills it if it is still running because another program could not be started.
  ~Running() {
    if (ended_) return;
    ::kill(process_, SIGKILL);
    while (::waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
    }
  }

  pid_t process() const { return process_; }

  /// Waits until it has ended.
  void end() {
    result_.output = read_tail(output_.reader.get(), deadline_);
    int status = 0;
    rusage used{};
    // Its descendants may hold the pipe open after it ends, and it may close the pipe and continue.
    while (!has_ended(status, used)) {
      if (deadline_ && Clock::now() >= *deadline_) {
        result_.out_of_time = true;
        ::kill(-group_, SIGKILL);
        deadline_.reset();
        continue;
      }
      constexpr std::chrono::milliseconds between{1};
      std::this_thread::sleep_for(between);
    }
    if (::read(start_error_.reader.get(), &error_, sizeof error_) != sizeof error_) error_ = {};
    if (WIFSIGNALED(status))
      result_.signal = WTERMSIG(status);
    else
      result_.exit_code = WEXITSTATUS(status);
    result_.out_of_time = result_.out_of_time || result_.signal == SIGXCPU;
    const bool failed = result_.signal != 0 || result_.exit_code != 0;
    result_.out_of_memory = failed && !result_.out_of_time && child_.memory_bytes > 0 && has_filled(used);
  }

  /// The result, once the child has ended.
  const ChildResult& result() const {
    if (error_.action == execution) fail(child_, why_not_executed(child_.program, error_.error));
    if (error_.action != nullptr) fail(child_, error_.action, error_.error);
    return result_;
  }

 private:
  /// Without a time limit, waits for the end.
  bool has_ended(int& status, rusage& used) {
    while (true) {
      const pid_t ended = ::wait4(process_, &status, deadline_ ? WNOHANG : 0, &used);
      if (ended < 0 && errno != EINTR) fail(child_, "waiting for it", errno);
      if (ended >= 0) return ended_ = ended == process_;
    }
  }

  /// Whether it used most of its memory limit. The system counts this process's memory as the child's too,
  /// which begins as a copy; if that alone is as much, the child's output decides.
  bool has_filled(const rusage& used) const {
    const auto has_most = [&](const rusage& usage) {
      return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024 > child_.memory_bytes / 4 * 3;
    };
    rusage own{};
    ::getrusage(RUSAGE_SELF, &own);
    const auto says = [&](const char* word) { return result_.output.find(word) != std::string::npos; };
    return has_most(used) && (!has_most(own) || says("memory") || says("bad_alloc"));
  }

  const ChildProcess& child_;
  Pipe output_, start_error_;  // the latter is empty if the program starts: exec closes it
  pid_t process_ = 0, group_ = 0;
  std::optional<Clock::time_point> deadline_;
  bool ended_ = false;
  StartError error_;
  ChildResult result_;
};

/// Ends silently in every case: without messages, a core file or sanitizer handlers.
[[noreturn]] void try_out(const std::function<void()>& work, unsigned most_seconds) {
  const rlimit no_core{0, 0}, seconds{most_seconds, most_seconds};
  ::setrlimit(RLIMIT_CORE, &no_core);
  ::setrlimit(RLIMIT_CPU, &seconds);
  for (const int crash : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) std::signal(crash, SIG_DFL);
  if (const int nowhere = ::open("/dev/null", O_WRONLY); nowhere >= 0) {
    ::dup2(nowhere, STDOUT_FILENO);
    ::dup2(nowhere, STDERR_FILENO);
  }
  try {
    work();
  } catch (...) {  // NOLINT(bugprone-empty-catch): thrown again when called for real
  }
  ::_exit(0);
}

// Data used by a signal handler must be global; atomic, because the system chooses the thread that handles a
// signal.
std::atomic<int> noted = 0;
std::atomic<pid_t> watched_group = 0;
std::atomic<int> received_signal = 0;
static_assert(std::atomic<int>::is_always_lock_free, "a handler may not wait for a lock");

void end_group(int signal) {
  received_signal = signal;
  if (const pid_t group = watched_group; group > 0) ::kill(-group, SIGKILL);
}

/// While it lives, the ending signals end the processes of one group instead of this one, and are kept for
/// throw_if_interrupted(). Ignored signals (nohup) stay ignored. Only one object at a time.
class InterruptionGuard {
 public:
  InterruptionGuard() {
    watched_group = 0;
    received_signal = 0;
    signals_.emplace(end_group, SA_RESTART);
  }
  InterruptionGuard(const InterruptionGuard&) = delete;
  InterruptionGuard& operator=(const InterruptionGuard&) = delete;
  ~InterruptionGuard() {
    watched_group = 0;
    signals_.reset();
    if (received_signal != 0) std::raise(received_signal);  // arrived after the last check
  }

  /// From now on, the signals end this process group; so does one that has arrived.
  static void watch(pid_t group) {
    watched_group = group;
    if (received_signal != 0) ::kill(-group, SIGKILL);
  }
  /// Throws Interrupted if a signal has arrived. A later one takes effect when the guard is destroyed.
  static void throw_if_interrupted() {
    if (const int signal = received_signal.exchange(0); signal != 0) throw Interrupted{signal};
  }

 private:
  std::optional<EndingSignals> signals_;
};

}  // namespace

bool is_readable(int descriptor, std::chrono::milliseconds patience) {
  const Clock::time_point limit = Clock::now() + patience;
  while (true) {
    const std::chrono::milliseconds left = std::max(time_until(limit), std::chrono::milliseconds{0});
    constexpr std::chrono::milliseconds longest = std::chrono::hours(24);
    pollfd event{descriptor, POLLIN, 0};
    if (::poll(&event, 1, static_cast<int>(std::min(left, longest).count())) > 0) return true;
    if (Clock::now() >= limit) return false;
  }
}

std::vector<char*> argv_of(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

std::string failed_end(const ChildResult& result, const std::string& doing) {
  if (result.signal == 0 && result.exit_code == 0) return "";
  std::istringstream lines(result.output);
  std::string cause;
  for (std::string line; std::getline(lines, line);) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    cause = ": " + line;
    if (to_lower(line).find("error") != std::string::npos) break;
  }
  return result.signal != 0
             ? fmt::format("ended with signal {} when {}{}", result.signal, doing, cause)
             : fmt::format("ended with exit code {} when {}{}", result.exit_code, doing, cause);
}

ChildResult run(const ChildProcess& child) { return run_together({&child, 1}).front(); }

std::vector<ChildResult> run_together(std::span<const ChildProcess> children) {
  const InterruptionGuard interruption;
  std::deque<Running> all;
  {
    const OnAllProcessCpus inherited;  // set before the fork, restored only in this process
    for (const ChildProcess& child : children)
      all.emplace_back(child, all.empty() ? 0 : all.front().process());
  }
  if (!all.empty()) InterruptionGuard::watch(all.front().process());
  for (Running& one : all) one.end();
  InterruptionGuard::throw_if_interrupted();
  std::vector<ChildResult> results;
  for (const Running& one : all) results.push_back(one.result());
  return results;
}

bool ends_in_trial(const std::function<void()>& work, unsigned most_seconds) {
  const pid_t trial = ::fork();
  if (trial < 0) return true;
  if (trial == 0) try_out(work, most_seconds);
  int status = 0;
  while (::waitpid(trial, &status, 0) < 0)
    if (errno != EINTR) return true;
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

void note_ending_signal(int signal) { noted = signal; }

int noted_ending_signal() { return noted; }

int take_ending_signal() { return noted.exchange(0); }

void release_ending_signals(void (*handler)(int signal)) {
  for (const int signal : ending_signals) {
    struct sigaction action {};
    if (::sigaction(signal, nullptr, &action) != 0 || action.sa_handler != handler) continue;
    action.sa_handler = SIG_DFL;
    ::sigaction(signal, &action, nullptr);
  }
}

EndingSignals::EndingSignals(void (*handler)(int signal), int flags) {
  for (std::size_t i = 0; i < ending_signals.size(); ++i) {
    ::sigaction(ending_signals[i], nullptr, &before_[i]);
    if (before_[i].sa_handler == SIG_IGN) continue;
    struct sigaction action {};
    action.sa_handler = handler;
    action.sa_flags = flags;
    ::sigaction(ending_signals[i], &action, nullptr);
  }
}

void EndingSignals::restore() const {
  for (std::size_t i = 0; i < ending_signals.size(); ++i)
    ::sigaction(ending_signals[i], &before_[i], nullptr);
}

void throw_if_ending_signal_noted() {
  if (const int signal = take_ending_signal(); signal != 0) throw Interrupted{signal};
}

}  // namespace mssim
