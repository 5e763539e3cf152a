#pragma once

#include <sys/file.h>
#include <sys/types.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace mssim {

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
  /// Closes and says whether that worked: some file systems report a failed write only here.
  bool close() { return ::close(std::exchange(descriptor_, -1)) == 0; }

  /// Keeps an open file or folder for one writer while it is open: false where another one has it, in any
  /// process. Leaves nothing behind, whatever ends the process. True on a file system that knows no locks.
  bool lock() const { return ::flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK; }

 private:
  int descriptor_;
};

/// How a program that was run ended.
struct ChildResult {
  int exit_code = 0;           ///< what it returned, when signal is 0
  int signal = 0;              ///< what ended it, or 0
  bool out_of_time = false;    ///< it was ended because its processor time or its elapsed time was over
  bool out_of_memory = false;  ///< it failed when it had more than three quarters of memory_bytes
  std::string output;          ///< what it wrote to stdout and stderr, the last 64 KiB
};

/// How a program failed, for the end of a sentence: "ended with signal 6 when DOING: " and the first line of
/// its output that speaks of an error, or else the last one. Empty where it returned 0.
std::string failed_end(const ChildResult& result, const std::string& doing);

/// What a program is run with.
struct ChildProcess {
  std::filesystem::path program;
  std::vector<std::string> arguments;    ///< without the program's name
  std::vector<std::string> environment;  ///< NAME=VALUE, added to this process's or replacing what it has
  std::filesystem::path folder;          ///< the folder it runs in
  unsigned cpu_seconds = 0;              ///< processor time after which the system ends it with SIGXCPU
  /// Time after which it is killed, with all that it started and all that runs together with it; 0: none.
  unsigned elapsed_seconds = 0;
  std::uint64_t memory_bytes = 0;  ///< the most address space that it gets; 0: as much as this process
};

/// Runs a program to its end: no shell, empty stdin, no core file. Throws std::runtime_error with one
/// sentence when it cannot be started, Interrupted when this process was told to end
/// meanwhile: then the program and all that it started have been killed.
ChildResult run(const ChildProcess& child);

/// Runs several at the same time, until all have ended: their results, in the same order. Throws like the one
/// above; where one cannot be started, after the others have ended.
std::vector<ChildResult> run_together(std::span<const ChildProcess> children);

/// Does `work` in a process of its own, a copy of this one, and says whether it came to an end: a library
/// that crashes, or does not end within `most_seconds` of processor time, then ends that process alone. What
/// `work` throws counts as an end, and what it prints is lost. True where no process can be made. Only this
/// thread is in the copy: `work` must not need others.
bool ends_in_trial(const std::function<void()>& work, unsigned most_seconds);

/// The signals by which a user ends a program: Ctrl-C, kill, a closed terminal, Ctrl-\.
inline constexpr std::array ending_signals{SIGINT, SIGTERM, SIGHUP, SIGQUIT};

/// Notes that such a signal has come, for those who look. Async-signal-safe.
void note_ending_signal(int signal);

/// The signal that was noted last and that nobody has taken, or 0.
int noted_ending_signal();

/// Takes the noted signal, or 0: nothing is noted any more.
int take_ending_signal();

/// While it lives, those signals call a handler, but for those that are ignored (nohup), which stay so.
class EndingSignals {
 public:
  /// `flags`: of sigaction.
  EndingSignals(void (*handler)(int signal), int flags);
  ~EndingSignals() { restore(); }
  EndingSignals(const EndingSignals&) = delete;
  EndingSignals& operator=(const EndingSignals&) = delete;

  /// They do again what they did before. Async-signal-safe.
  void restore() const;

 private:
  std::array<struct sigaction, ending_signals.size()> before_{};
};

/// Thrown when the user ends mssim (Ctrl-C, a closed terminal, kill) while another program runs for it, so
/// that what is half made is cleared away on the way out. The program then ends by that signal, as it would
/// have at once. Not a std::exception: nothing but the end of the program is to catch it.
struct Interrupted {
  int signal;
};

/// Throws Interrupted with the noted signal, which it takes, where there is one.
void throw_if_ending_signal_noted();

/// While it lives, the ending signals end the processes of one group instead of this one, and wait to
/// be asked for. Signals that are ignored (nohup) stay so. One at a time.
class InterruptionGuard {
 public:
  /// Until watch() the signals are held back, so that none falls between a fork and its watch.
  InterruptionGuard();
  ~InterruptionGuard();

  /// To be called in a forked child: its signals become what they were before the guard. Async-signal-safe.
  void release_child() const;
  /// From now on the signals end this process group.
  void watch(pid_t group);
  /// Throws Interrupted when a signal has come. One that comes later acts when the guard goes.
  void throw_if_interrupted();

 private:
  sigset_t before_{};
  std::optional<EndingSignals> signals_;
};

}  // namespace mssim
