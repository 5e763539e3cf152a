#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "platform/process.h"

namespace mssim {

// Protocol between mssim (supervised_process.cpp) and libexec/mssim/supervise (src/supervise.cpp). The
// supervisor's arguments: COUNT PATH... FOLDER CPUS COUNT NAME=VALUE... PROGRAM ARGUMENT..., where COUNT is
// the number of the following items, PATHs are removed if mssim ends before the program, and CPUS is like
// "0,1," or empty. Descriptor 3 is its end of the channel, a stream.

/// A one-byte request from mssim. Each is answered. If mssim closes its end, the supervisor kills everything.
enum class SupervisorRequest : char { pause, resume, processor_time, peak_memory };

/// Kinds of answers of the supervisor.
enum class SupervisorWord : int {
  no_process,     ///< it cannot make a pipe or a process; value: errno
  no_folder,      ///< the program's folder cannot be entered; value: errno
  no_processors,  ///< the program cannot be bound to its CPUs; value: errno
  no_program,     ///< the program cannot be executed; value: errno
  started,        ///< value: the program's process, which is also its process group
  done,           ///< the request has been carried out
  ended           ///< the program and all its descendants are gone; value: as of waitpid
};

/// An answer; if the program has ended, its last output follows.
struct SupervisorAnswer {
  SupervisorWord word = SupervisorWord::no_process;
  int value = 0;
  double processor_seconds = 0;  ///< with done and ended
  std::size_t output_bytes = 0;  ///< with ended
  std::uint64_t peak_bytes = 0;  ///< with done, after peak_memory; 0 if unknown
};

/// Maximum size of the output that is kept.
inline constexpr std::size_t kept_output_bytes = 64 * 1024;

/// A program to start, its environment and CPUs.
struct SupervisedProgram {
  std::filesystem::path program;         ///< a file; if relative, then to `folder`; PATH is not searched
  std::vector<std::string> arguments;    ///< without the program's name
  std::vector<std::string> environment;  ///< NAME=VALUE, added to mssim's; replaces variables of that name
  std::filesystem::path folder;          ///< working directory
  std::vector<int> cpus;                 ///< logical CPUs that it is bound to; empty: those of mssim
  /// Files and folders that are removed, with their contents, if mssim ends before the program does, for
  /// example by SIGKILL. Otherwise the caller removes them.
  std::vector<std::filesystem::path> removed = {};
};

/// How a program ended.
struct ProgramEnd {
  int exit_code = 0;    ///< if signal is 0
  int signal = 0;       ///< the signal that ended it, or 0; SIGKILL if mssim ended it
  std::string output;   ///< stdout and stderr of it and its descendants, the last 64 KiB
  std::string trouble;  ///< why its end is unknown: end of a sentence that begins with its name
};

/// End of a sentence that begins with the program's name: "ended with exit code 3", "was ended by signal 11
/// (Segmentation fault)".
std::string describe(const ProgramEnd& end);

/// An untrusted program that runs in parallel with mssim: it and all its descendants are gone when this
/// object is destroyed, or when mssim ends, however that happens. libexec/mssim/supervise runs it and
/// collects its output; if the program stops the supervisor, mssim continues it. The program has an empty
/// stdin, its own process group and session, which no key of mssim's terminal reaches, no descriptor of
/// mssim's, and no core file. Several may be started at the same time; each is used by one thread at a time.
class SupervisedProcess {
 public:
  /// Throws std::runtime_error with one sentence if the program cannot be started.
  explicit SupervisedProcess(const SupervisedProgram& program);
  /// Kills all of it at once.
  ~SupervisedProcess();

  /// Stops all its processes, including those that left its group, until resume(). No effect once it has
  /// ended.
  void pause();
  void resume();

  /// Becomes readable when the program and all its descendants are gone; poll it, do not read it.
  int end_descriptor() const { return channel_.get(); }

  /// Gives the program `patience` to end by itself (resumed, if it was paused), then kills all of it. Later
  /// calls return the same result.
  const ProgramEnd& end(std::chrono::milliseconds patience);

  /// CPU time of the program so far, s: of its living processes by their clocks, and of ended ones if their
  /// parents have waited for them (in clock ticks, 0.01 s).
  double processor_seconds() const;
  /// Sum of the largest resident memory that each of its living processes has had, bytes; nothing once it has
  /// ended, or if the system does not tell.
  std::optional<std::uint64_t> peak_bytes() const;

 private:
  std::optional<SupervisorAnswer> ask(SupervisorRequest request) const;
  bool says_something() const;
  std::optional<SupervisorAnswer> hear() const;
  void take_end(const SupervisorAnswer& answer) const;
  void lose(const std::string& trouble) const;

  Descriptor channel_;
  pid_t supervisor_ = 0, program_ = 0;
  bool paused_ = false;
  // State that any answer may change.
  mutable bool ended_ = false;
  mutable ProgramEnd end_;
  mutable double processor_seconds_ = 0;
};

}  // namespace mssim
