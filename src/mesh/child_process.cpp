#include "mesh/child_process.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "mesh/interruption.h"

namespace mssim {
namespace {

[[noreturn]] void fail(const ChildProcess& child, const std::string& action, int error) {
  throw std::runtime_error("cannot run " + child.program.string() + ": " + action + " failed (" +
                           std::strerror(error) + ")");
}

/// The two ends of a pipe; the child inherits neither but as stdout and stderr.
class Pipe {
 public:
  explicit Pipe(const ChildProcess& child) {
    if (::pipe2(ends_.data(), O_CLOEXEC) != 0) fail(child, "opening a pipe", errno);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  ~Pipe() {
    close_writer();
    ::close(ends_[0]);
  }
  int reader() const { return ends_[0]; }
  int writer() const { return ends_[1]; }
  void close_writer() {
    if (ends_[1] >= 0) ::close(ends_[1]);
    ends_[1] = -1;
  }

 private:
  std::array<int, 2> ends_{-1, -1};
};

std::vector<char*> pointers_to(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

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
  // A lower limit that is already in force may not be raised; then it stays, which is as good.
  ::setrlimit(static_cast<__rlimit_resource>(resource), &limits);
}

/// What the child does between fork and exec, where only async-signal-safe calls are allowed: this process
/// may have threads. Returns errno when something fails.
int become(const char* program, char* const* arguments, char* const* environment, const char* folder,
           unsigned cpu_seconds, int output) {
  // A group of its own, so that what it starts in turn can be ended with it; and no orphan if this process is
  // killed.
  if (::setpgid(0, 0) != 0 || ::prctl(PR_SET_PDEATHSIG, SIGKILL) != 0) return errno;
  const int nothing = ::open("/dev/null", O_RDONLY);
  if (nothing < 0 || ::dup2(nothing, STDIN_FILENO) < 0) return errno;
  if (::dup2(output, STDOUT_FILENO) < 0 || ::dup2(output, STDERR_FILENO) < 0) return errno;
  limit(RLIMIT_CPU, cpu_seconds, cpu_seconds + 1);
  limit(RLIMIT_CORE, 0, 0);
  if (::chdir(folder) != 0) return errno;
  ::execve(program, arguments, environment);
  return errno;
}

/// Reads to the end; keeps the last bytes.
std::string read_tail(int descriptor) {
  constexpr std::size_t kept = 64 * 1024;
  std::string tail;
  std::array<char, 4096> buffer;
  while (true) {
    const ssize_t bytes = ::read(descriptor, buffer.data(), buffer.size());
    if (bytes < 0 && errno == EINTR) continue;
    if (bytes <= 0) break;
    tail.append(buffer.data(), static_cast<std::size_t>(bytes));
    if (tail.size() > 2 * kept) tail.erase(0, tail.size() - kept);
  }
  if (tail.size() > kept) tail.erase(0, tail.size() - kept);
  return tail;
}

}  // namespace

ChildResult run(const ChildProcess& child) {
  std::vector<std::string> arguments{child.program.filename().string()};
  arguments.insert(arguments.end(), child.arguments.begin(), child.arguments.end());
  std::vector<std::string> environment = environment_with(child.environment);
  const std::vector<char*> argument_pointers = pointers_to(arguments);
  const std::vector<char*> environment_pointers = pointers_to(environment);

  Pipe output(child);
  Pipe start_error(child);  // stays empty when the program starts: exec closes it
  InterruptionGuard interruption;
  const pid_t process = ::fork();
  if (process < 0) fail(child, "fork", errno);
  if (process == 0) {
    interruption.release_child();
    const int error = become(child.program.c_str(), argument_pointers.data(), environment_pointers.data(),
                             child.folder.c_str(), child.cpu_seconds, output.writer());
    [[maybe_unused]] const ssize_t written = ::write(start_error.writer(), &error, sizeof error);
    ::_exit(127);
  }
  ::setpgid(process, process);  // here as well, so that the group exists before it is watched
  interruption.watch(process);
  output.close_writer();
  start_error.close_writer();

  ChildResult result;
  result.output = read_tail(output.reader());
  int error = 0;
  const bool failed_to_start = ::read(start_error.reader(), &error, sizeof error) == sizeof error;
  int status = 0;
  while (::waitpid(process, &status, 0) < 0)
    if (errno != EINTR) fail(child, "waiting for it", errno);
  interruption.throw_if_interrupted();
  if (failed_to_start) fail(child, "starting it", error);
  if (WIFSIGNALED(status))
    result.signal = WTERMSIG(status);
  else
    result.exit_code = WEXITSTATUS(status);
  return result;
}

}  // namespace mssim
