// Runs one program for mssim (platform/supervised_process.h), in a small process of its own: takes what the
// program writes, stops and continues it, and ends all that it started, when the program ends and when mssim
// does, be it by SIGKILL. As a subreaper it becomes the parent of every orphan of the program, so that none
// gets away. Needs nothing but the C library: it starts in less than a millisecond.

#include <dirent.h>
#include <fcntl.h>
#include <poll.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/signalfd.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <initializer_list>

#include "platform/supervisor_words.h"

namespace {

using mssim::SupervisorAnswer;
using mssim::SupervisorRequest;
using mssim::SupervisorWord;

constexpr int channel = 3;

/// The last bytes that the program wrote.
class Output {
 public:
  explicit Output(int descriptor) : descriptor_(descriptor) {}
  int descriptor() const { return descriptor_; }

  /// Takes what there is, 64 KiB at most; false where there is nothing now.
  bool take() {
    const ssize_t bytes = ::read(descriptor_, kept_ + next_, sizeof kept_ - next_);
    if (bytes == 0 || (bytes < 0 && errno != EINTR && errno != EAGAIN)) {
      ::close(descriptor_);
      descriptor_ = -1;  // which poll() skips
    }
    if (bytes <= 0) return false;
    next_ += static_cast<std::size_t>(bytes);
    if (next_ == sizeof kept_) {
      full_ = true;
      next_ = 0;
    }
    return true;
  }
  std::size_t bytes() const { return full_ ? sizeof kept_ : next_; }
  /// Both parts of the ring, the older one first.
  template <class Use>
  void give(Use use) const {
    if (full_) use(kept_ + next_, sizeof kept_ - next_);
    use(kept_, next_);
  }

 private:
  int descriptor_;
  char kept_[mssim::kept_output_bytes];
  std::size_t next_ = 0;
  bool full_ = false;
};

/// Where mssim is gone, nobody hears it, and nothing happens.
void say(const void* bytes, std::size_t count) {
  while (count > 0) {
    const ssize_t sent = ::send(channel, bytes, count, MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return;
    bytes = static_cast<const char*>(bytes) + sent;
    count -= static_cast<std::size_t>(sent);
  }
}

void say(SupervisorWord word, int value, double processor_seconds = 0, std::size_t output_bytes = 0) {
  const SupervisorAnswer answer{word, value, processor_seconds, output_bytes};
  say(&answer, sizeof answer);
}

/// Processes, in an array that grows.
class Processes {
 public:
  ~Processes() { std::free(all_); }
  void add(pid_t process) {
    if (count_ == capacity_) {
      const std::size_t capacity = 2 * capacity_ + 64;
      auto* larger = static_cast<pid_t*>(std::realloc(all_, capacity * sizeof(pid_t)));
      if (larger == nullptr) return;
      all_ = larger;
      capacity_ = capacity;
    }
    all_[count_++] = process;
  }
  void clear() { count_ = 0; }
  std::size_t count() const { return count_; }
  pid_t operator[](std::size_t place) const { return all_[place]; }

 private:
  pid_t* all_ = nullptr;
  std::size_t count_ = 0, capacity_ = 0;
};

/// Reads a small file of /proc; empty where it cannot be read.
std::size_t read_text(const char* path, char* text, std::size_t most) {
  const int file = ::open(path, O_RDONLY | O_CLOEXEC);
  std::size_t count = 0;
  while (file >= 0 && count + 1 < most) {
    const ssize_t bytes = ::read(file, text + count, most - 1 - count);
    if (bytes <= 0) break;
    count += static_cast<std::size_t>(bytes);
  }
  if (file >= 0) ::close(file);
  text[count] = 0;
  return count;
}

/// Calls `use` with each entry of a folder of /proc that is a number.
template <class Use>
void for_each_number(const char* folder, Use use) {
  DIR* entries = ::opendir(folder);
  if (entries == nullptr) return;
  while (const dirent* entry = ::readdir(entries))
    if (const int number = std::atoi(entry->d_name); number > 0) use(number);
  ::closedir(entries);
}

/// Of /proc/PROCESS/stat.
struct Stat {
  int parent = 0;
  unsigned long waited_user = 0, waited_system = 0;  // of children that it has waited for, in ticks

  explicit Stat(pid_t process) {
    char path[64], text[1024];
    std::snprintf(path, sizeof path, "/proc/%d/stat", process);
    read_text(path, text, sizeof text);
    // The name, in parentheses, may have any characters.
    const char* rest = std::strrchr(text, ')');
    if (rest == nullptr) return;
    std::sscanf(rest + 1, " %*c %d %*d %*d %*d %*d %*u %*u %*u %*u %*u %*u %*u %lu %lu", &parent,
                &waited_user, &waited_system);
  }
};

/// Adds the children of a process: as its threads list them, or, where the kernel was built without those
/// lists, by a look at all processes.
void add_children(pid_t process, Processes& all) {
  static char text[64 * 1024];
  static const bool lists = [] {
    char path[64];
    std::snprintf(path, sizeof path, "/proc/self/task/%d/children", ::getpid());
    return ::access(path, R_OK) == 0;
  }();
  if (!lists) {
    for_each_number("/proc", [&](pid_t one) {
      if (Stat(one).parent == process) all.add(one);
    });
    return;
  }
  char folder[64];
  std::snprintf(folder, sizeof folder, "/proc/%d/task", process);
  for_each_number(folder, [&](int thread) {
    char path[128];
    std::snprintf(path, sizeof path, "%s/%d/children", folder, thread);
    read_text(path, text, sizeof text);
    char* rest = text;
    while (const long child = std::strtol(rest, &rest, 10)) all.add(static_cast<pid_t>(child));
  });
}

void find_descendants(Processes& all) {
  all.clear();
  add_children(::getpid(), all);
  for (std::size_t i = 0; i < all.count(); ++i) add_children(all[i], all);
}

/// Sends SIGSTOP or SIGCONT to all that the program started. Its group gets a signal at once, whatever it
/// forks; those that left the group are looked for until no more appear.
void signal_all(pid_t program, int signal) {
  ::kill(-program, signal);
  Processes all;
  std::size_t before = 0;
  for (int look = 0; look < 20; ++look) {
    find_descendants(all);
    for (std::size_t i = 0; i < all.count(); ++i) ::kill(all[i], signal);
    if (signal == SIGCONT || all.count() == before) break;
    before = all.count();
  }
}

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

/// Of all that the program started: of those that live by their clocks, and of those that were waited for.
double processor_seconds() {
  rusage waited{};
  ::getrusage(RUSAGE_CHILDREN, &waited);
  double sum = seconds(waited.ru_utime) + seconds(waited.ru_stime);
  const double ticks = static_cast<double>(::sysconf(_SC_CLK_TCK));
  Processes all;
  find_descendants(all);
  for (std::size_t i = 0; i < all.count(); ++i) {
    clockid_t clock = 0;
    timespec time{};
    if (::clock_getcpuclockid(all[i], &clock) == 0 && ::clock_gettime(clock, &time) == 0)
      sum += static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
    const Stat stat(all[i]);
    sum += static_cast<double>(stat.waited_user + stat.waited_system) / ticks;
  }
  return sum;
}

/// Whether the program has ended. It is not waited for yet, so that the number of its group stays its own;
/// its orphans that have ended are.
bool has_ended(pid_t program) {
  while (true) {
    siginfo_t info{};
    if (::waitid(P_ALL, 0, &info, WEXITED | WNOHANG | WNOWAIT) != 0 || info.si_pid == 0) return false;
    if (info.si_pid == program) return true;
    ::waitpid(info.si_pid, nullptr, 0);
  }
}

/// Kills all that the program started, until none is left. Returns how the program ended. When a child
/// dies, its children become ours, and another look finds them: there is one after each death, and one a
/// second where a look missed any.
int end_all(pid_t program, int deaths) {
  int ending = 0;
  ::kill(-program, SIGKILL);
  Processes children;
  while (true) {
    children.clear();
    add_children(::getpid(), children);
    for (std::size_t i = 0; i < children.count(); ++i) ::kill(children[i], SIGKILL);
    int status = 0;
    const pid_t ended = ::waitpid(-1, &status, WNOHANG);
    if (ended < 0 && errno == ECHILD) return ending;
    if (ended == program) ending = status;
    if (ended > 0) continue;
    pollfd death{deaths, POLLIN, 0};
    ::poll(&death, 1, 1000);
    signalfd_siginfo signal;
    [[maybe_unused]] const ssize_t read = ::read(deaths, &signal, sizeof signal);
  }
}

/// What could not be done before the program, and why.
struct Failure {
  SupervisorWord word;
  int error;
};

/// In the child: becomes the program, or returns why not.
Failure become(char** arguments, int output, const char* folder, const char* cpus, pid_t supervisor) {
  if (::setpgid(0, 0) != 0 || ::prctl(PR_SET_PDEATHSIG, SIGKILL) != 0)
    return {SupervisorWord::no_process, errno};
  if (::getppid() != supervisor) ::_exit(127);
  if (::dup2(output, STDOUT_FILENO) < 0 || ::dup2(output, STDERR_FILENO) < 0)
    return {SupervisorWord::no_process, errno};
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  if (*cpus != 0) {
    cpu_set_t mask;
    CPU_ZERO(&mask);
    char* rest = nullptr;
    for (; *cpus != 0; cpus = rest + (*rest == ',')) CPU_SET(std::strtoul(cpus, &rest, 10), &mask);
    if (::sched_setaffinity(0, sizeof mask, &mask) != 0) return {SupervisorWord::no_processors, errno};
  }
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  if (::chdir(folder) != 0) return {SupervisorWord::no_folder, errno};
  ::execv(arguments[0], arguments);
  return {SupervisorWord::no_program, errno};
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 5) return 2;
  const char* const folder = arguments[1];
  const char* const cpus = arguments[2];
  const int variables = std::atoi(arguments[3]);
  for (int i = 0; i < variables; ++i) ::putenv(arguments[4 + i]);
  ::closefrom(channel + 1);
  ::fcntl(channel, F_SETFD, FD_CLOEXEC);

  sigset_t heard;
  ::sigemptyset(&heard);
  for (const int signal : {SIGCHLD, SIGTERM, SIGINT, SIGHUP, SIGQUIT}) ::sigaddset(&heard, signal);
  ::sigprocmask(SIG_BLOCK, &heard, nullptr);
  const int signals = ::signalfd(-1, &heard, SFD_CLOEXEC | SFD_NONBLOCK);
  int pipe[2] = {-1, -1}, trouble[2] = {-1, -1};
  const pid_t self = ::getpid();
  pid_t program = -1;
  if (signals >= 0 && ::prctl(PR_SET_CHILD_SUBREAPER, 1) == 0 && ::pipe2(pipe, O_CLOEXEC) == 0 &&
      ::pipe2(trouble, O_CLOEXEC) == 0)
    program = ::fork();
  if (program < 0) {
    say(SupervisorWord::no_process, errno);
    return 1;
  }
  if (program == 0) {
    const Failure failure = become(arguments + 4 + variables, pipe[1], folder, cpus, self);
    [[maybe_unused]] const ssize_t written = ::write(trouble[1], &failure, sizeof failure);
    ::_exit(127);
  }
  ::close(pipe[1]);
  ::close(trouble[1]);
  Failure failure{};
  ssize_t bytes = 0;
  while ((bytes = ::read(trouble[0], &failure, sizeof failure)) < 0 && errno == EINTR) {
  }
  ::close(trouble[0]);
  if (bytes == sizeof failure) {
    say(failure.word, failure.error);
    return 1;
  }
  say(SupervisorWord::started, program);

  static Output output(pipe[0]);
  ::fcntl(output.descriptor(), F_SETFL, O_NONBLOCK);
  bool goes_on = true;
  while (goes_on) {
    pollfd events[] = {{channel, POLLIN, 0}, {signals, POLLIN, 0}, {output.descriptor(), POLLIN, 0}};
    if (::poll(events, 3, -1) < 0) continue;
    if (events[2].revents != 0) output.take();
    if (events[1].revents != 0) {
      signalfd_siginfo signal{};
      if (::read(signals, &signal, sizeof signal) == sizeof signal)
        goes_on = signal.ssi_signo == SIGCHLD && !has_ended(program);
    }
    if (events[0].revents == 0 || !goes_on) continue;
    SupervisorRequest request{};
    if (::recv(channel, &request, sizeof request, 0) != sizeof request) break;
    if (request == SupervisorRequest::pause) signal_all(program, SIGSTOP);
    if (request == SupervisorRequest::resume) signal_all(program, SIGCONT);
    const bool timed = request == SupervisorRequest::processor_time;
    say(SupervisorWord::done, 0, timed ? processor_seconds() : 0);
  }
  const int ending = end_all(program, signals);
  while (output.take()) {
  }
  say(SupervisorWord::ended, ending, processor_seconds(), output.bytes());
  output.give([](const char* part, std::size_t size) { say(part, size); });
  return 0;
}
