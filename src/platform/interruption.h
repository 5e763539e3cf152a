#pragma once

#include <sys/types.h>

#include <csignal>
#include <optional>

#include "platform/ending_signals.h"

namespace mssim {

/// Thrown when the user ends mssim (Ctrl-C, a closed terminal, kill) while another program runs for it, so
/// that what is half made is cleared away on the way out. The program then ends by that signal, as it would
/// have at once. Not a std::exception: nothing but the end of the program is to catch it.
struct Interrupted {
  int signal;
};

/// Throws Interrupted with the noted signal (ending_signals.h), which it takes, where there is one.
void throw_if_ending_signal_noted();

/// While it lives, the ending signals end the processes of one group instead of this one, and wait to
/// be asked for. Signals that are ignored (nohup) stay so. One at a time.
class InterruptionGuard {
 public:
  /// Until watch() the signals are held back, so that none falls between a fork and its watch.
  InterruptionGuard();
  ~InterruptionGuard();
  InterruptionGuard(const InterruptionGuard&) = delete;
  InterruptionGuard& operator=(const InterruptionGuard&) = delete;

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
