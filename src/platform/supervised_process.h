#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "platform/descriptor.h"
#include "platform/supervisor_words.h"

namespace mssim {

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
  SupervisedProcess(const SupervisedProcess&) = delete;
  SupervisedProcess& operator=(const SupervisedProcess&) = delete;

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
