#pragma once

#include <sched.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <future>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace mssim {

/// Numbers of the logical CPUs that the process may use, in ascending order; empty if the system does not
/// report them. Not the calling thread's affinity mask, unless OpenMP binds no threads: with OMP_PROC_BIND or
/// OMP_PLACES it binds the first thread to its own CPU before main begins.
std::vector<int> process_cpus();

/// While it lives, the calling thread may use all process_cpus(), and the threads and processes that it
/// starts inherit that. Otherwise they would share the one CPU that OpenMP has bound this thread to.
class OnAllProcessCpus {
 public:
  OnAllProcessCpus();
  ~OnAllProcessCpus();
  OnAllProcessCpus(const OnAllProcessCpus&) = delete;
  OnAllProcessCpus& operator=(const OnAllProcessCpus&) = delete;

 private:
  cpu_set_t before_{};
  bool changed_ = false;
};

/// Launch policy for std::async: in a new thread, or, if the system refuses one, in the thread that waits for
/// the result.
inline constexpr std::launch as_the_system_can = std::launch::async | std::launch::deferred;

/// Calls `work` with 0 to `count` - 1, at most `at_once` at the same time. Throws what `work` throws.
void for_each_at_once(std::size_t count, std::size_t at_once, const std::function<void(std::size_t)>& work);

/// Limits of control groups (cgroups), as containers, Slurm and systemd set them: for each limit, the least
/// of this process's group and its ancestors. Nothing without a limit.
struct ContainerLimits {
  std::optional<double> processors;           ///< CPU seconds per second
  std::optional<std::uint64_t> memory_bytes;  ///< the limit
  /// Bytes of it that are not in use; the page cache counts as unused, because the kernel releases it before
  /// it refuses memory.
  std::optional<std::uint64_t> memory_left;
};

/// Reads the limits of cgroups version 1 and 2. `root` is prepended to /proc and to the mount folders.
ContainerLimits container_limits(const std::filesystem::path& root = "/");

/// Bytes that this process can still allocate: the kernel's available memory, or what the address-space limit
/// (`ulimit -v`) or a container's limit leaves if that is less.
std::uint64_t available_memory();

/// "needs at least 3.20 GB of memory, but 1.00 GB are available", with enough digits to distinguish the two;
/// nothing if the available memory suffices. Both in bytes.
std::optional<std::string> memory_shortage(std::uint64_t needed, std::uint64_t available);

/// Compares with the memory available now (available_memory), bytes.
std::optional<std::string> memory_shortage(std::uint64_t needed);

/// The highest rise of this process's resident memory since construction, which returns free memory of the
/// heap to the system. Only one may live at a time: the system knows one peak of a process.
class MemoryPeak {
 public:
  MemoryPeak();
  /// Bytes; nothing if the system does not let a process forget its earlier peak.
  std::optional<std::uint64_t> rise() const;

 private:
  std::optional<std::uint64_t> before_;
};

/// Restarts the program with the same arguments if OpenMP's threads would spin as long as libgomp does by
/// default, tens of milliseconds. On CPUs that other programs use, two threads can end up on one CPU, where
/// each spins while the other should work. libgomp reads its spin count once, before main(). Call it first in
/// main(). Returns if the user has set the waiting (OMP_WAIT_POLICY, GOMP_SPINCOUNT), if the program was
/// already restarted, and if that is impossible. Programs that mssim runs do not inherit the setting.
void start_with_short_waits(char** argv);

/// Why OpenMP cannot have `threads` threads, including the calling one: the number that the system allows and
/// a remedy; nothing if it can. Tests it by creating them, because OpenMP ends the process if a thread cannot
/// be created. A success is not repeated, because OpenMP keeps its threads.
std::optional<std::string> thread_shortage(int threads);

/// Why so many threads make no sense, as what follows "are": more than eight per CPU of this process, so each
/// step would take as long as the system needs to run them all. Nothing if they do.
std::optional<std::string> thread_excess(int threads);

/// Threads for a parallel region whose result does not depend on their number: `wanted` (0: OpenMP's
/// default), or fewer if the system allows only those.
int openmp_team(int wanted);

/// Wall time since construction, from a monotonic clock.
class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

/// The facts that decide how an output stream is written; the texts are environment variables, empty if
/// unset.
struct StreamFacts {
  bool is_terminal = false;
  int columns = 0;  ///< of the terminal; 0 if unknown
  std::string term = {}, no_color = {}, lc_all = {}, lc_ctype = {}, lang = {};
};

/// Capabilities of an output stream.
struct Terminal {
  std::optional<int> width = {};  ///< columns; nothing if it is not a terminal: no limit
  bool rewrites = false;          ///< lines can be overwritten with escape sequences
  bool colours = false;           ///< colours may be used, in addition to characters
  bool utf8 = false;              ///< characters beyond ASCII are displayed
};

/// Colours need a terminal that knows escape sequences and no NO_COLOR (no-color.org).
Terminal terminal_with(const StreamFacts& facts);

/// The capabilities of a descriptor in this environment. Only this function inspects a stream's type.
Terminal terminal_of(int descriptor);

/// The usual name of an instruction set that Highway names: "AVX-512" for "AVX3". Highway's other names are
/// the usual ones, and unchanged.
std::string_view instruction_set_name(std::string_view highway_name);

/// What a backend says that it ran on, as people know it: "cpu AVX-512" for "cpu AVX3", and "PoCL on MODEL"
/// for what PoCL calls a processor, DRIVER-TARGET-MODEL, where the target is LLVM's. Anything else as it is.
std::string device_name(std::string_view device);

}  // namespace mssim
