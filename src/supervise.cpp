// Runs one program for mssim (platform/supervised_process.h), in a small process of its own: collects its
// output, stops and continues it, and kills all its descendants when the program ends and when mssim exits,
// even by SIGKILL. As a subreaper it becomes the parent of all orphans of the program, so no process escapes.
// It uses only the C library and therefore starts quickly.

#include <dirent.h>
#include <fcntl.h>
#include <ftw.h>
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

#include "platform/supervised_process.h"

namespace {

using mssim::SupervisorAnswer;
using mssim::SupervisorRequest;
using mssim::SupervisorWord;

constexpr int channel = 3;

/// The program's output, of which the last bytes are kept.
class Output {
 public:
  explicit Output(int descriptor) : descriptor_(descriptor) {}
  int descriptor() const { return descriptor_; }
  /// Reads some of the available output; false if there is none now.
  bool take() {
    if (end_ == sizeof text_) std::memcpy(text_, text_ + (end_ -= most), most);
    const ssize_t bytes = ::read(descriptor_, text_ + end_, sizeof text_ - end_);
    if (bytes == 0) descriptor_ = -1;  // all writers have closed it; poll() skips it
    if (bytes > 0) end_ += static_cast<std::size_t>(bytes);
    return bytes > 0;
  }
  std::size_t size() const { return end_ < most ? end_ : most; }
  const char* last() const { return text_ + end_ - size(); }

 private:
  static constexpr std::size_t most = mssim::kept_output_bytes;
  int descriptor_;
  char text_[2 * most];
  std::size_t end_ = 0;
};

/// False if mssim is gone.
bool say(const void* bytes, std::size_t count) {
  while (count > 0) {
    const ssize_t sent = ::send(channel, bytes, count, MSG_NOSIGNAL);
    if (sent <= 0) return false;
    bytes = static_cast<const char*>(bytes) + sent;
    count -= static_cast<std::size_t>(sent);
  }
  return true;
}

bool say(const SupervisorAnswer& answer) { return say(&answer, sizeof answer); }

/// Process ids. If there are more than fit, they are handled in parts.
struct Processes {
  std::size_t count = 0;
  pid_t all[32 * 1024];
  void add(pid_t process) {
    if (count < sizeof all / sizeof *all) all[count++] = process;
  }
};

/// Calls `use` with each numeric entry of a folder of /proc.
template <class Use>
void for_each_number(const char* folder, Use use) {
  DIR* entries = ::opendir(folder);
  if (entries == nullptr) return;
  while (const dirent* entry = ::readdir(entries))
    if (const int number = std::atoi(entry->d_name); number > 0) use(number);
  ::closedir(entries);
}

/// Fields of /proc/PROCESS/stat, or of /proc/PROCESS/task/THREAD/stat for a thread.
struct Stat {
  char state = 'X';  ///< X: no such process
  int parent = 0;
  unsigned long waited_user = 0, waited_system = 0;  // of children that it has waited for, in ticks

  explicit Stat(pid_t process) {
    char path[64];
    std::snprintf(path, sizeof path, "/proc/%d/stat", process);
    read(path);
  }
  Stat(pid_t process, pid_t thread) {
    char path[64];
    std::snprintf(path, sizeof path, "/proc/%d/task/%d/stat", process, thread);
    read(path);
  }
  /// It uses no CPU time until it is continued, or it has ended.
  bool rests() const { return std::strchr("TtZXx", state) != nullptr; }

 private:
  void read(const char* path) {
    char text[1024];
    std::FILE* file = std::fopen(path, "re");
    if (file == nullptr) return;
    text[std::fread(text, 1, sizeof text - 1, file)] = 0;
    std::fclose(file);
    // The name, in parentheses, may contain any characters. The state is the first word after it; the times
    // of children that were waited for are words 14 and 15.
    if (const char* rest = std::strrchr(text, ')'))
      std::sscanf(rest, ") %c %d %*d %*d %*d %*d %*u %*u %*u %*u %*u %*u %*u %lu %lu", &state, &parent,
                  &waited_user, &waited_system);
  }
};

/// Adds the children of a process: from the lists of its threads, or from a scan of all processes if the
/// kernel was built without those lists.
void add_children(pid_t process, Processes& all) {
  bool listed = false;
  char path[64];
  std::snprintf(path, sizeof path, "/proc/%d/task", process);
  for_each_number(path, [&](int thread) {
    std::snprintf(path, sizeof path, "/proc/%d/task/%d/children", process, thread);
    std::FILE* file = std::fopen(path, "re");
    if (file == nullptr) return;
    listed = true;
    for (pid_t child = 0; std::fscanf(file, "%d", &child) == 1;) all.add(child);
    std::fclose(file);
  });
  if (listed || ::kill(process, 0) != 0) return;
  for_each_number("/proc", [&](pid_t one) {
    if (Stat(one).parent == process) all.add(one);
  });
}

/// All descendants of this process, parents before their children.
const Processes& descendants() {
  static Processes found;
  found.count = 0;
  add_children(::getpid(), found);
  for (std::size_t i = 0; i < found.count; ++i) add_children(found.all[i], found);
  return found;
}

/// Sends SIGSTOP or SIGCONT to the program and all its descendants: to its group at once, even while it
/// forks, then to those that left the group, until no more are found.
void signal_all(pid_t program, int signal) {
  ::kill(-program, signal);
  std::size_t before = 0;
  for (int look = 0; look < 20; ++look) {
    const Processes& found = descendants();
    for (std::size_t i = 0; i < found.count; ++i) ::kill(found.all[i], signal);
    if (signal == SIGCONT || found.count == before) break;
    before = found.count;
  }
}

/// Whether no thread of the program and its descendants can use CPU time.
bool all_rest() {
  const Processes& found = descendants();
  bool rest = true;
  char path[64];
  for (std::size_t i = 0; i < found.count; ++i) {
    std::snprintf(path, sizeof path, "/proc/%d/task", found.all[i]);
    for_each_number(path, [&](int thread) { rest = rest && Stat(found.all[i], thread).rests(); });
  }
  return rest;
}

/// Stops the program and its descendants, and waits until they have stopped: a thread handles SIGSTOP when it
/// is next scheduled, which could otherwise be while another program is timed. It gives up after 0.1 s,
/// because a thread that waits for a disk or a driver may take long.
void pause_all(pid_t program) {
  signal_all(program, SIGSTOP);
  constexpr timespec look{0, 200'000};
  for (int looks = 0; looks < 500 && !all_rest(); ++looks) ::nanosleep(&look, nullptr);
}

/// CPU time of the program and its descendants: of living ones by their clocks, and of those that were waited
/// for.
double processor_seconds() {
  rusage waited{};
  ::getrusage(RUSAGE_CHILDREN, &waited);
  double sum = static_cast<double>(waited.ru_utime.tv_sec + waited.ru_stime.tv_sec) +
               1e-6 * static_cast<double>(waited.ru_utime.tv_usec + waited.ru_stime.tv_usec);
  const double ticks = static_cast<double>(::sysconf(_SC_CLK_TCK));
  const Processes& living = descendants();
  for (std::size_t i = 0; i < living.count; ++i) {
    clockid_t clock = 0;
    timespec time{};
    if (::clock_getcpuclockid(living.all[i], &clock) == 0 && ::clock_gettime(clock, &time) == 0)
      sum += static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
    const Stat stat(living.all[i]);
    sum += static_cast<double>(stat.waited_user + stat.waited_system) / ticks;
  }
  return sum;
}

/// Sum of the largest resident memory that each living process of the program and its descendants has had,
/// bytes; 0 if the system does not tell.
std::uint64_t peak_bytes() {
  const Processes& living = descendants();
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < living.count; ++i) {
    char line[128];
    std::snprintf(line, sizeof line, "/proc/%d/status", living.all[i]);
    std::FILE* file = std::fopen(line, "re");
    unsigned long kibibytes = 0;
    while (file != nullptr && std::fgets(line, sizeof line, file) != nullptr)
      if (std::sscanf(line, "VmHWM: %lu", &kibibytes) == 1) sum += std::uint64_t{1024} * kibibytes;
    if (file != nullptr) std::fclose(file);
  }
  return sum;
}

/// Whether the program has ended. It is not reaped yet, so that its group's number is not reused; its ended
/// orphans are.
bool has_ended(pid_t program) {
  while (true) {
    siginfo_t info{};
    if (::waitid(P_ALL, 0, &info, WEXITED | WNOHANG | WNOWAIT) != 0 || info.si_pid == 0) return false;
    if (info.si_pid == program) return true;
    ::waitpid(info.si_pid, nullptr, 0);
  }
}

/// Kills all descendants until none is left. Returns how the program ended. When a child dies, its children
/// become ours and the next scan finds them: one scan after each death, and one per second in case a scan
/// missed some.
int end_all(pid_t program, int deaths) {
  static Processes children;
  int ending = 0;
  ::kill(-program, SIGKILL);
  while (true) {
    children.count = 0;
    add_children(::getpid(), children);
    for (std::size_t i = 0; i < children.count; ++i) ::kill(children.all[i], SIGKILL);
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

/// For nftw: continues if an entry cannot be removed.
int remove_entry(const char* path, const struct stat*, int, FTW*) {
  std::remove(path);
  return 0;
}

/// In the child: executes the program, or returns why it cannot.
SupervisorAnswer become(char** arguments, int output, const char* folder, const char* cpus,
                        pid_t supervisor) {
  if (::setpgid(0, 0) != 0 || ::prctl(PR_SET_PDEATHSIG, SIGKILL) != 0 || ::dup2(output, STDOUT_FILENO) < 0 ||
      ::dup2(output, STDERR_FILENO) < 0)
    return {SupervisorWord::no_process, errno};
  if (::getppid() != supervisor) ::_exit(127);  // it ended before PR_SET_PDEATHSIG took effect
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

/// Starts the program and notifies mssim. Returns its process id; a negative number if it cannot be started.
pid_t start(char** arguments, int output, const char* folder, const char* cpus) {
  int trouble[2] = {-1, -1};  // stays empty if the program starts: exec closes it
  const pid_t self = ::getpid();
  const pid_t program = ::pipe2(trouble, O_CLOEXEC) == 0 ? ::fork() : -1;
  SupervisorAnswer answer{SupervisorWord::no_process, errno};
  if (program == 0) {
    answer = become(arguments, output, folder, cpus, self);
    [[maybe_unused]] const ssize_t written = ::write(trouble[1], &answer, sizeof answer);
    ::_exit(127);
  }
  ::close(trouble[1]);
  if (program > 0 && ::read(trouble[0], &answer, sizeof answer) == 0)
    answer = {SupervisorWord::started, program};
  ::close(trouble[0]);
  const bool started = answer.word == SupervisorWord::started;
  if (!started) ::waitpid(program, nullptr, 0);
  say(answer);
  return started ? program : -1;
}

/// Runs until the program has ended, mssim ends it, or a signal ends the supervisor.
void attend(pid_t program, Output& output, int signals) {
  while (true) {
    pollfd events[] = {{channel, POLLIN, 0}, {signals, POLLIN, 0}, {output.descriptor(), POLLIN, 0}};
    if (::poll(events, 3, -1) < 0) continue;
    if (events[2].revents != 0) output.take();
    if (events[1].revents != 0) {
      signalfd_siginfo signal{};
      if (::read(signals, &signal, sizeof signal) != sizeof signal) continue;
      if (signal.ssi_signo != SIGCHLD || has_ended(program)) return;
    }
    if (events[0].revents == 0) continue;
    SupervisorRequest request{};
    if (::recv(channel, &request, sizeof request, 0) != sizeof request) return;
    if (request == SupervisorRequest::pause) pause_all(program);
    if (request == SupervisorRequest::resume) signal_all(program, SIGCONT);
    const bool timed = request == SupervisorRequest::processor_time;
    const bool weighed = request == SupervisorRequest::peak_memory;
    say({SupervisorWord::done, 0, timed ? processor_seconds() : 0, 0, weighed ? peak_bytes() : 0});
  }
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 6) return 2;
  const int paths = std::atoi(arguments[1]);
  char** const removed = arguments + 2;
  arguments += 1 + paths;
  const int variables = std::atoi(arguments[3]);
  for (int i = 0; i < variables; ++i) ::putenv(arguments[4 + i]);
  ::closefrom(channel + 1);
  ::fcntl(channel, F_SETFD, FD_CLOEXEC);
  sigset_t heard;
  ::sigemptyset(&heard);
  constexpr int signals_heard[] = {SIGCHLD, SIGTERM, SIGINT, SIGHUP, SIGQUIT};
  for (const int signal : signals_heard) ::sigaddset(&heard, signal);
  ::sigprocmask(SIG_BLOCK, &heard, nullptr);
  const int signals = ::signalfd(-1, &heard, SFD_CLOEXEC | SFD_NONBLOCK);
  int pipe[2] = {-1, -1};
  ::prctl(PR_SET_CHILD_SUBREAPER, 1);  // qemu-user 7 lacks it: there, orphans escape
  if (signals < 0 || ::pipe2(pipe, O_CLOEXEC) != 0) {
    say({SupervisorWord::no_process, errno});
    return 1;
  }
  const pid_t program = start(arguments + 4 + variables, pipe[1], arguments[1], arguments[2]);
  ::close(pipe[1]);
  if (program < 0) return 1;
  ::fcntl(pipe[0], F_SETFL, O_NONBLOCK);
  static Output output(pipe[0]);
  attend(program, output, signals);
  const int ending = end_all(program, signals);
  while (output.take()) {
  }
  const SupervisorAnswer last{SupervisorWord::ended, ending, processor_seconds(), output.size()};
  if (!say(last))  // mssim was killed and cannot remove them
    for (int i = 0; i < paths; ++i) ::nftw(removed[i], remove_entry, 16, FTW_DEPTH | FTW_PHYS);
  say(output.last(), output.size());
  return 0;
}
