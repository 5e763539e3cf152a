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

/// Numbers of the logical CPUs that the process may use, in ascending order; empty where the system does not
/// tell. Not the calling thread's affinity mask, unless OpenMP binds no threads: with OMP_PROC_BIND or
/// OMP_PLACES it binds the first one to a CPU of its own before main begins.
std::vector<int> process_cpus();

/// While it lives, the calling thread may move to all of process_cpus(), and the threads and processes that
/// it starts inherit that: they would otherwise share the one CPU that OpenMP has bound this thread to.
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

/// How std::async starts what should run beside the caller: in a thread, or where the system makes none, in
/// that which waits for it.
inline constexpr std::launch as_the_system_can = std::launch::async | std::launch::deferred;

/// Calls `work` with 0 to `count` - 1, so many at the same time. Throws what `work` throws.
void for_each_at_once(std::size_t count, std::size_t at_once, const std::function<void(std::size_t)>& work);

/// What control groups (cgroups) let this process have, as containers, Slurm and systemd set them: of the
/// group that it is in and of those that this is in, each the least. None where there is no limit.
struct ContainerLimits {
  std::optional<double> processors;           ///< processor seconds a second
  std::optional<std::uint64_t> memory_bytes;  ///< the limit
  /// Bytes of it that are not in use; the kernel gives up its copies of files before it refuses memory, so
  /// that they count as unused.
  std::optional<std::uint64_t> memory_left;
};

/// Asks cgroups of version 1 and 2. `root` stands before /proc and the folders where cgroups are mounted.
ContainerLimits container_limits(const std::filesystem::path& root = "/");

/// Bytes that this process can still get: what the kernel calls available, or what the address-space limit
/// (`ulimit -v`) or a container's limit leaves if that is less.
std::uint64_t available_memory();

/// "needs at least 3.20 GB of memory, but 1.00 GB are available", in as many digits as tell the two apart;
/// none where the available memory suffices. Both in bytes.
std::optional<std::string> memory_shortage(std::uint64_t needed, std::uint64_t available);

/// Compares with the memory that is available now (available_memory), bytes.
std::optional<std::string> memory_shortage(std::uint64_t needed);

/// Starts the program anew, with its arguments, where OpenMP's threads would wait for each other as long as
/// libgomp does by default: some ten milliseconds, in which they spin. On processors that other programs use,
/// two threads then come to lie on one of them, where each spins while the other one should work. libgomp
/// reads how long it spins before main() and never again. To be called first of all in main(); returns where
/// the user has said how to wait (OMP_WAIT_POLICY, GOMP_SPINCOUNT), where the program has been started anew,
/// and where that is impossible. What the program starts itself is told nothing of it.
void start_with_short_waits(char** argv);

/// The stack that threads get: that of any thread, or that which OpenMP gives (OMP_STACKSIZE).
enum class ThreadStack : std::uint8_t { usual, openmp };

/// Why the system does not make so many threads, the calling one included: how many it makes, and what to do.
/// None where it does. Tries it: a thread that cannot be made ends a process that asks OpenMP for it. What
/// has succeeded for OpenMP is not tried again, because OpenMP keeps its threads.
std::optional<std::string> thread_shortage(int threads, ThreadStack stack);

/// How many threads a parallel region can have whose result does not depend on their number: `wanted` (0: as
/// many as OpenMP takes by itself), or where the system does not make so many, as many as it makes.
int openmp_team(int wanted);

/// Wall time since it was made, by a clock that is never set back.
class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

/// What decides how an output stream is written; the texts are variables of the environment, empty where
/// unset.
struct StreamFacts {
  bool is_terminal = false;
  int columns = 0;  ///< as the terminal says; 0 where it does not
  std::string_view term = {}, no_color = {}, lc_all = {}, lc_ctype = {}, lang = {};
};

/// What may be written to an output stream.
struct Terminal {
  std::optional<int> width = {};  ///< columns; none where it is no terminal, and nothing has to fit
  bool rewrites = false;          ///< lines may be written over, by escape sequences
  bool colours = false;           ///< in addition to what characters say
  bool utf8 = false;              ///< characters beyond ASCII are shown
};

/// Colours need a terminal that knows escape sequences and no NO_COLOR (no-color.org).
Terminal terminal_with(const StreamFacts& facts);

/// What may be written to a descriptor, in this environment. The only place that asks what a stream leads to.
Terminal terminal_of(int descriptor);

/// Highway's name of an instruction set as people know it: "AVX-512" for "AVX3"; the others are their
/// makers'.
std::string_view instruction_set_name(std::string_view highway_name);

/// What a backend says that it ran on, as people know it: "cpu AVX-512" for "cpu AVX3", and "PoCL on MODEL"
/// for what PoCL calls a processor, DRIVER-TARGET-MODEL, where the target is LLVM's. Anything else as it is.
std::string device_name(std::string_view device);

}  // namespace mssim
