#pragma once

#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace mssim {

/// An environment variable, or `otherwise` if it is unset or empty.
inline std::string variable(const char* name, const char* otherwise = "") {
  const char* value = std::getenv(name);
  return value && *value ? value : otherwise;
}

/// An open file descriptor, closed with its owner.
class Descriptor {
 public:
  explicit Descriptor(int descriptor = -1) : descriptor_(descriptor) {}
  Descriptor(Descriptor&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    return *this;
  }
  ~Descriptor() {
    if (is_open()) ::close(descriptor_);
  }
  bool is_open() const { return descriptor_ >= 0; }
  int get() const { return descriptor_; }
  /// Closes and returns whether that succeeded: some file systems report a failed write only here.
  bool close() { return ::close(std::exchange(descriptor_, -1)) == 0; }

  /// Locks an open file or folder for one writer while it is open: false if another process or descriptor has
  /// the lock. Leaves nothing behind, however the process ends. True on a file system without locks.
  bool lock() const { return ::flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK; }

 private:
  int descriptor_;
};

/// Whether data, or the end, can be read from a descriptor within `patience`.
bool is_readable(int descriptor, std::chrono::milliseconds patience);

/// The texts as execve() takes them, with a null pointer at the end. They must outlive it.
std::vector<char*> argv_of(std::vector<std::string>& texts);

/// How a program ended.
struct ChildResult {
  int exit_code = 0;           ///< if signal is 0
  int signal = 0;              ///< the signal that ended it, or 0
  bool out_of_time = false;    ///< ended because it exceeded its CPU time or elapsed time
  bool out_of_memory = false;  ///< it failed with more than three quarters of memory_bytes in use
  std::string output;          ///< its stdout and stderr, the last 64 KiB
};

/// The failure of a program, for the end of a sentence: "ended with signal 6 when DOING: " and the first line
/// of its output that mentions an error, else the last line. Empty if it returned 0.
std::string failed_end(const ChildResult& result, const std::string& doing);

/// A program to run, its environment and its limits.
struct ChildProcess {
  std::filesystem::path program;
  std::vector<std::string> arguments;    ///< without the program's name
  std::vector<std::string> environment;  ///< NAME=VALUE, added to this process's or replacing it
  std::filesystem::path folder;          ///< working directory
  unsigned cpu_seconds = 0;              ///< CPU time after which the system ends it with SIGXCPU; 0: none
  /// Elapsed time after which it, its descendants and all programs run together with it are killed; 0: none.
  unsigned elapsed_seconds = 0;
  std::uint64_t memory_bytes = 0;  ///< limit of its address space; 0: that of this process
};

/// Runs a program to its end: no shell, empty stdin, no core file. Throws MissingProgram, with one
/// sentence, if it cannot be started, and Interrupted if this process received an ending signal meanwhile:
/// then the program and its descendants have been killed.
ChildResult run(const ChildProcess& child);

/// Runs several programs at the same time, until all have ended; results in the same order. Throws like
/// run(const ChildProcess&); if a program cannot be executed, only after the others have ended.
std::vector<ChildResult> run_together(std::span<const ChildProcess> children);

/// Runs `work` in a forked copy of this process and returns whether it finished. A library that crashes, or
/// uses more than `most_seconds` of CPU time, ends only that copy. An exception from `work` counts as
/// finished; its output is discarded. True if the system cannot fork. The copy has only this thread, so
/// `work` must not need others.
bool ends_in_trial(const std::function<void()>& work, unsigned most_seconds);

/// Signals by which a user ends a program: Ctrl-C, kill, a closed terminal, Ctrl-\.
inline constexpr std::array ending_signals{SIGINT, SIGTERM, SIGHUP, SIGQUIT};

/// Notes that such a signal has arrived. Async-signal-safe.
void note_ending_signal(int signal);

/// The last noted signal that has not been taken, or 0.
int noted_ending_signal();

/// Takes the noted signal and clears the note; 0 if there is none.
int take_ending_signal();

/// Lets each ending signal that calls `handler` end this process again. Async-signal-safe.
void release_ending_signals(void (*handler)(int signal));

/// While it lives, the ending signals call a handler, except ignored ones (nohup), which stay ignored.
class EndingSignals {
 public:
  /// `flags`: those of sigaction.
  EndingSignals(void (*handler)(int signal), int flags);
  ~EndingSignals() { restore(); }
  EndingSignals(const EndingSignals&) = delete;
  EndingSignals& operator=(const EndingSignals&) = delete;

  /// Restores their previous actions. Async-signal-safe.
  void restore() const;

 private:
  std::array<struct sigaction, ending_signals.size()> before_{};
};

/// Thrown if the user ends mssim (Ctrl-C, a closed terminal, kill) while another program runs for it, so that
/// partial results are removed during unwinding. The program then ends by that signal. Not a std::exception:
/// only the end of the program may catch it.
struct Interrupted {
  int signal;
};

/// If a signal is noted, takes it and throws Interrupted with it.
void throw_if_ending_signal_noted();

}  // namespace mssim
