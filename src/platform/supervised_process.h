#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "platform/process.h"

namespace mssim {

// What mssim (supervised_process.cpp) and libexec/mssim/supervise (src/supervise.cpp) say to each other. The
// supervisor's arguments: COUNT PATH... FOLDER CPUS COUNT NAME=VALUE... PROGRAM ARGUMENT..., where COUNT is
// the number of what follows, PATHs are removed where mssim has ended before the program, and CPUS is as
// "0,1," or empty. Descriptor 3 is its end of the channel, a stream.

/// One byte from mssim. Each is answered. When mssim closes its end, the supervisor ends everything.
enum class SupervisorRequest : char { pause, resume, processor_time };

/// What the supervisor answers.
enum class SupervisorWord : int {
  no_process,     ///< it cannot make a pipe or a process; value: errno
  no_folder,      ///< the program's folder cannot be entered; value: errno
  no_processors,  ///< the program cannot be bound to its processors; value: errno
  no_program,     ///< the program cannot be executed; value: errno
  started,        ///< value: the program's process, which is its process group as well
  done,           ///< what was asked for has been done
  ended           ///< the program and all that it started are gone; value: as waitpid has it
};

/// An answer; the last output follows it when the program has ended.
struct SupervisorAnswer {
  SupervisorWord word = SupervisorWord::no_process;
  int value = 0;
  double processor_seconds = 0;  ///< with done and ended
  std::size_t output_bytes = 0;  ///< with ended
};

/// How much of the output is kept.
inline constexpr std::size_t kept_output_bytes = 64 * 1024;

/// What a program is started with.
struct SupervisedProgram {
  std::filesystem::path program;  ///< a file; where it is relative, from the folder; PATH is not searched
  std::vector<std::string> arguments;    ///< without the program's name
  std::vector<std::string> environment;  ///< NAME=VALUE, added to mssim's or replacing what it has
  std::filesystem::path folder;          ///< the folder it runs in
  std::vector<int> cpus;                 ///< the logical CPUs it is bound to; empty: those that mssim may use
  /// Files and folders that are removed with all that is in them where mssim ends before the program does, as
  /// by SIGKILL. Else they are the caller's to remove.
  std::vector<std::filesystem::path> removed = {};
};

/// How a program ended.
struct ProgramEnd {
  int exit_code = 0;   ///< what it returned, when signal is 0
  int signal = 0;      ///< what ended it, or 0; SIGKILL where mssim ended it
  std::string output;  ///< what it and all that it started wrote to stdout and stderr, the last 64 KiB
  std::string
      trouble;  ///< why mssim does not know how it ended: the end of a sentence that begins with its name
};

/// The end of a sentence that begins with the program's name: "ended with exit code 3", "was ended by
/// signal 11 (Segmentation fault)".
std::string describe(const ProgramEnd& end);

/// A program that runs beside mssim, which does not trust it: whatever it does, it and all that it started
/// are gone when this object is, or when mssim is, however that ends. Between the two stands
/// libexec/mssim/supervise, which also takes what the program writes; a program that stops it is not left
/// alone by that: it is continued. The program has an empty stdin, a process group and session that no key of
/// mssim's terminal reaches, no descriptor of mssim's, and leaves no core file. Several may be started at the
/// same time; each is used by one thread at a time.
class SupervisedProcess {
 public:
  /// Throws std::runtime_error with one sentence when the program cannot be started.
  explicit SupervisedProcess(const SupervisedProgram& program);
  /// Ends all of it at once.
  ~SupervisedProcess();

  /// Stops all its processes, also those that have left its group, until resume(). Nothing once it has ended.
  void pause();
  void resume();

  /// Readable once the program has ended and all that it started is gone; to be polled, not read.
  int end_descriptor() const { return channel_.get(); }

  /// Gives the program that time to end by itself (resumed, if it was paused), then ends all of it. Once it
  /// has ended, the same again.
  const ProgramEnd& end(std::chrono::milliseconds patience);

  /// Processor time of the program so far, in seconds: of its processes that live, by their clocks, and of
  /// those that ended, as far as their parents have waited for them (in clock ticks, 0.01 s).
  double processor_seconds() const;

 private:
  bool ask(SupervisorRequest request) const;
  bool says_something() const;
  bool hear(SupervisorAnswer& answer) const;
  void take_end(const SupervisorAnswer& answer) const;
  void lose(const std::string& trouble) const;

  Descriptor channel_;
  pid_t supervisor_ = 0, program_ = 0;
  bool paused_ = false;
  // What any answer may bring.
  mutable bool ended_ = false;
  mutable ProgramEnd end_;
  mutable double processor_seconds_ = 0;
};

}  // namespace mssim
