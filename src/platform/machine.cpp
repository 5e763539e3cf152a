#include "platform/machine.h"

#include <malloc.h>
#include <omp.h>
#include <pthread.h>
#include <sys/ioctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <cstdlib>
#include <deque>
#include <fstream>
#include <limits>
#include <mutex>
#include <sstream>
#include <system_error>
#include <thread>

#include "platform/process.h"
#include "text/text.h"

namespace mssim {

std::vector<int> process_cpus() {
  std::vector<int> cpus;
  const bool bound = omp_get_proc_bind() != omp_proc_bind_false;
  for (int place = 0; bound && place < omp_get_num_places(); ++place) {
    std::vector<int> ids(static_cast<std::size_t>(omp_get_place_num_procs(place)));
    omp_get_place_proc_ids(place, ids.data());
    cpus.insert(cpus.end(), ids.begin(), ids.end());
  }
  if (cpus.empty()) {
    cpu_set_t mask;
    CPU_ZERO(&mask);
    if (sched_getaffinity(0, sizeof mask, &mask) != 0) return cpus;
    for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu)
      if (CPU_ISSET(static_cast<std::size_t>(cpu), &mask)) cpus.push_back(cpu);
  }
  std::sort(cpus.begin(), cpus.end());
  cpus.erase(std::unique(cpus.begin(), cpus.end()), cpus.end());
  return cpus;
}

OnAllProcessCpus::OnAllProcessCpus() {
  cpu_set_t all;
  CPU_ZERO(&all);
  for (const int cpu : process_cpus()) CPU_SET(static_cast<std::size_t>(cpu), &all);
  changed_ = sched_getaffinity(0, sizeof before_, &before_) == 0 && !CPU_EQUAL(&all, &before_) &&
             sched_setaffinity(0, sizeof all, &all) == 0;
}

OnAllProcessCpus::~OnAllProcessCpus() {
  if (changed_) sched_setaffinity(0, sizeof before_, &before_);
}

void for_each_at_once(std::size_t count, std::size_t at_once, const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next = 0;
  const OnAllProcessCpus unbound;  // threads outside OpenMP would share the CPU of this one
  std::vector<std::future<void>> threads;
  for (std::size_t thread = 0; thread < std::min(at_once, count); ++thread)
    threads.push_back(std::async(as_the_system_can, [&] {
      for (std::size_t i = next++; i < count; i = next++) work(i);
    }));
  for (std::future<void>& thread : threads) thread.get();
}

namespace {

namespace fs = std::filesystem;

/// Files of one kind of limit in a group's folder.
struct Dialect {
  bool unified;  ///< version 2, whose groups have all controllers
  std::string_view quota, period, limit, used, file_prefix;
};
/// Empty name: version 2 has quota and period in one file.
constexpr Dialect version_1{
    false,   "cpu.cfs_quota_us", "cpu.cfs_period_us", "memory.limit_in_bytes", "memory.usage_in_bytes",
    "total_"};
constexpr Dialect version_2{true, "cpu.max", "", "memory.max", "memory.current", ""};

/// A folder where control groups are mounted.
struct Mount {
  const Dialect* dialect;
  std::string controllers;  ///< version 1: with a comma before and after each
  std::string root;         ///< the group that is mounted there
  fs::path folder;
};

/// The numbers at the start of a file, up to the first word that is not a number, such as "max".
std::vector<std::int64_t> numbers_in(const fs::path& file) {
  std::ifstream in(file);
  std::vector<std::int64_t> numbers;
  for (std::int64_t number = 0; in >> number;) numbers.push_back(number);
  return numbers;
}

/// Mounts in /proc/self/mountinfo: "36 35 98:0 /root /folder options [more...] - cgroup source options".
std::vector<Mount> mounts(const fs::path& root) {
  std::vector<Mount> found;
  std::ifstream in(root / "proc/self/mountinfo");
  for (std::string line; std::getline(in, line);) {
    const std::size_t dash = line.find(" - ");
    if (dash == std::string::npos) continue;
    std::istringstream before(line.substr(0, dash)), behind(line.substr(dash + 3));
    std::string skipped, group, folder, type, source, options;
    before >> skipped >> skipped >> skipped >> group >> folder;
    behind >> type >> source >> options;
    if (type == "cgroup" || type == "cgroup2")
      found.push_back({type == "cgroup" ? &version_1 : &version_2, ',' + options + ',', group,
                       root / fs::path(folder).relative_path()});
  }
  return found;
}

/// This process's group in the hierarchy mounted there, from /proc/self/cgroup: "4:cpu,cpuacct:/group", in
/// version 2 "0::/group". A group outside the mount's root is invisible; the root replaces it.
fs::path own_group(const Mount& mount, const fs::path& root) {
  std::ifstream in(root / "proc/self/cgroup");
  for (std::string line; std::getline(in, line);) {
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    const std::string_view any = std::string_view(controllers).substr(0, controllers.find(','));
    const bool same =
        mount.dialect->unified
            ? controllers.empty()
            : !any.empty() && mount.controllers.find(',' + std::string(any) + ',') != std::string::npos;
    if (!same) continue;
    std::string_view group = std::string_view(line).substr(second + 1);
    if (group.starts_with("/..")) return {};
    if (mount.root != "/") {
      if (!group.starts_with(mount.root)) return {};
      group.remove_prefix(mount.root.size());
    }
    return fs::path(group).relative_path();
  }
  return {};
}

template <class Number>
void take_least(std::optional<Number>& least, Number number) {
  least = std::min(least.value_or(number), number);
}

/// The group's page cache, which the kernel releases when memory is needed.
std::uint64_t file_bytes(const fs::path& statistics, std::string_view prefix) {
  std::ifstream in(statistics);
  std::uint64_t sum = 0, bytes = 0;
  for (std::string key; in >> key >> bytes;)
    if (key == std::string(prefix) + "inactive_file" || key == std::string(prefix) + "active_file")
      sum += bytes;
  return sum;
}

void add_group(ContainerLimits& limits, const Dialect& dialect, const fs::path& folder) {
  std::vector<std::int64_t> quota = numbers_in(folder / dialect.quota);
  if (!dialect.period.empty())
    for (const std::int64_t period : numbers_in(folder / dialect.period)) quota.push_back(period);
  if (quota.size() == 2 && quota[0] > 0 && quota[1] > 0)
    take_least(limits.processors, static_cast<double>(quota[0]) / static_cast<double>(quota[1]));

  // Version 1 reports no limit as the largest number, rounded down to a page.
  constexpr std::int64_t none = std::int64_t{1} << 62;
  const std::vector<std::int64_t> limit = numbers_in(folder / dialect.limit);
  if (limit.empty() || limit[0] < 0 || limit[0] >= none) return;
  const auto bytes = static_cast<std::uint64_t>(limit[0]);
  take_least(limits.memory_bytes, bytes);
  const std::vector<std::int64_t> used = numbers_in(folder / dialect.used);
  const std::uint64_t in_use =
      used.empty() ? 0 : static_cast<std::uint64_t>(std::max<std::int64_t>(used[0], 0));
  const std::uint64_t files = std::min(in_use, file_bytes(folder / "memory.stat", dialect.file_prefix));
  take_least(limits.memory_left, bytes - std::min(bytes, in_use - files));
}

/// The number of a line "NAME NUMBER kB" of a file of /proc, in bytes; `name` ends in a colon. Nothing if
/// there is no such line.
std::optional<std::uint64_t> bytes_in(const char* file, std::string_view name) {
  std::ifstream in(file);
  for (std::string key; in >> key;) {
    std::uint64_t kibibytes = 0;
    if (key == name && in >> kibibytes) return kibibytes * 1024;
    in.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  }
  return std::nullopt;
}

/// Memory left by the address-space limit.
std::uint64_t limit_available() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
    return std::numeric_limits<std::uint64_t>::max();
  std::uint64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  const std::uint64_t used = pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
  return limit.rlim_cur > used ? limit.rlim_cur - used : 0;
}

std::string in_gigabytes(std::uint64_t bytes, int digits) {
  return fmt::format("{:.{}f} GB", static_cast<double>(bytes) * 1e-9, digits);
}

constexpr const char* spin_variable = "GOMP_SPINCOUNT";
/// Tens to hundreds of microseconds, depending on the CPU's pause instruction. The sign, which only this
/// program writes, shows that it restarted itself.
constexpr std::string_view short_spins = "+1000";

/// OMP_STACKSIZE as libgomp reads it, in bytes; nothing if it is unset or not a size.
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

/// A thread that waits until told to end.
struct Waiter {
  pthread_t handle{};
  std::atomic<bool>* may_end = nullptr;
  pid_t number = 0;  // the system's thread id; known when it has ended

  static void* run(void* argument) {
    auto& self = *static_cast<Waiter*>(argument);
    self.number = gettid();
    self.may_end->wait(false);
    return nullptr;
  }
  /// The system counts a thread for a moment after others can see that it has ended.
  void end_and_leave() const {
    pthread_join(handle, nullptr);
    const std::string folder = fmt::format("/proc/self/task/{}", number);
    const auto latest = std::chrono::steady_clock::now() + std::chrono::seconds(1);
    while (access(folder.c_str(), F_OK) == 0 && std::chrono::steady_clock::now() < latest)
      std::this_thread::yield();
  }
};

struct Trial {
  int made = 1;  ///< simultaneous threads, including the caller
  int error = 0;
};

/// Of OpenMP's stack size.
Trial make_threads(int wanted) {
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  // libgomp also ignores a size that is refused.
  if (const auto bytes = openmp_stack_bytes()) pthread_attr_setstacksize(&attributes, *bytes);
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

Trial try_threads(int wanted) {
  static std::mutex one_at_a_time;  // concurrent trials would count each other's threads
  static int openmp_has_made = 1;
  const std::lock_guard lock(one_at_a_time);
  if (wanted <= openmp_has_made) return {wanted};
  const Trial trial = make_threads(wanted);
  openmp_has_made = std::max(openmp_has_made, trial.made);
  return trial;
}

/// The locale by the C library's rule: the first of the three that is not empty.
bool is_utf8(const StreamFacts& facts) {
  const std::string_view locale = !facts.lc_all.empty()     ? facts.lc_all
                                  : !facts.lc_ctype.empty() ? facts.lc_ctype
                                                            : facts.lang;
  for (const std::string_view name : {"UTF-8", "utf-8", "UTF8", "utf8"})
    if (locale.find(name) != std::string_view::npos) return true;
  return false;
}

}  // namespace

ContainerLimits container_limits(const fs::path& root) {
  ContainerLimits limits;
  for (const Mount& mount : mounts(root)) {
    const fs::path group = own_group(mount, root);
    fs::path folder = mount.folder;
    add_group(limits, *mount.dialect, folder);
    for (const fs::path& name : group) add_group(limits, *mount.dialect, folder /= name);
  }
  return limits;
}

std::uint64_t available_memory() {
  const std::uint64_t available =
      std::min(bytes_in("/proc/meminfo", "MemAvailable:").value_or(std::numeric_limits<std::uint64_t>::max()),
               limit_available());
  return std::min(available, container_limits().memory_left.value_or(available));
}

std::optional<std::string> memory_shortage(std::uint64_t needed, std::uint64_t available) {
  if (needed <= available) return std::nullopt;
  constexpr int single_bytes = 9;
  int digits = 2;
  while (digits < single_bytes && in_gigabytes(needed, digits) == in_gigabytes(available, digits)) ++digits;
  return fmt::format("needs at least {} of memory, but {} are available", in_gigabytes(needed, digits),
                     in_gigabytes(available, digits));
}

std::optional<std::string> memory_shortage(std::uint64_t needed) {
  return memory_shortage(needed, available_memory());
}

MemoryPeak::MemoryPeak() {
  malloc_trim(0);
  std::ofstream forget("/proc/self/clear_refs");
  if (forget << "5" << std::flush) before_ = bytes_in("/proc/self/status", "VmRSS:");
}

std::optional<std::uint64_t> MemoryPeak::rise() const {
  const std::optional<std::uint64_t> peak = bytes_in("/proc/self/status", "VmHWM:");
  if (!before_ || !peak) return std::nullopt;
  return *peak - std::min(*peak, *before_);
}

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
  // The restarted program would inherit the one CPU that OpenMP bound this thread to, and see no other.
  const OnAllProcessCpus on_all_cpus;
  execv(program.c_str(), argv);
  unsetenv(spin_variable);
}

std::optional<std::string> thread_shortage(int threads) {
  if (const int limit = omp_get_thread_limit(); threads > limit)
    return fmt::format("{} were requested, and OMP_THREAD_LIMIT allows {}: request fewer, or unset it",
                       pluralize(threads, "thread"), limit);
  const Trial trial = try_threads(threads);
  if (trial.made >= threads) return std::nullopt;
  const char* size = std::getenv("OMP_STACKSIZE");
  return fmt::format(
      "{} were requested; the system allows {} ({}): request fewer with --threads, raise the limit of "
      "processes (ulimit -u, or pids.max of a container){}",
      pluralize(threads, "thread"), trial.made, std::generic_category().message(trial.error),
      size ? fmt::format(", or lower OMP_STACKSIZE, which is {}", size) : "");
}

std::optional<std::string> thread_excess(int threads) {
  constexpr int most_a_processor = 8;
  const int processors = omp_get_num_procs();
  if (threads <= most_a_processor * processors) return std::nullopt;
  return fmt::format("too many for the {} that this process may use; request at most {} threads, {} for each",
                     pluralize(processors, "processor"), most_a_processor * processors, most_a_processor);
}

int openmp_team(int wanted) {
  const int threads = wanted > 0 ? wanted : omp_get_max_threads();
  return std::min(threads, try_threads(threads).made);
}

Terminal terminal_with(const StreamFacts& facts) {
  constexpr int usual_width = 80;
  Terminal terminal;
  terminal.utf8 = is_utf8(facts);
  if (!facts.is_terminal) return terminal;
  terminal.width = facts.columns > 0 ? facts.columns : usual_width;
  terminal.rewrites = !facts.term.empty() && facts.term != "dumb";
  terminal.colours = terminal.rewrites && facts.no_color.empty();
  return terminal;
}

Terminal terminal_of(int descriptor) {
  StreamFacts facts{.term = variable("TERM"),
                    .no_color = variable("NO_COLOR"),
                    .lc_all = variable("LC_ALL"),
                    .lc_ctype = variable("LC_CTYPE"),
                    .lang = variable("LANG")};
  facts.is_terminal = isatty(descriptor) != 0;
  winsize size{};
  if (facts.is_terminal && ioctl(descriptor, TIOCGWINSZ, &size) == 0) facts.columns = size.ws_col;
  return terminal_with(facts);
}

std::string_view instruction_set_name(std::string_view highway_name) {
  return highway_name == "AVX3" ? "AVX-512" : highway_name;
}

std::string device_name(std::string_view device) {
  constexpr std::string_view host = "cpu ";
  if (device.starts_with(host))
    return std::string(host).append(instruction_set_name(device.substr(host.size())));
  // LLVM's targets are written small, and models begin with a capital.
  for (const std::string_view driver : {"pthread-", "cpu-", "basic-"}) {
    if (!device.starts_with(driver)) continue;
    for (std::size_t at = driver.size() - 1; (at = device.find('-', at)) != std::string_view::npos;)
      if (++at < device.size() && std::isupper(static_cast<unsigned char>(device[at])) != 0)
        return "PoCL on " + std::string(device.substr(at));
  }
  return std::string(device);
}

}  // namespace mssim
