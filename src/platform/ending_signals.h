#pragma once

#include <array>
#include <csignal>

namespace mssim {

/// The signals by which a user ends a program: Ctrl-C, kill, a closed terminal, Ctrl-\.
inline constexpr std::array ending_signals{SIGINT, SIGTERM, SIGHUP, SIGQUIT};

/// Notes that such a signal has come, for those who look. Async-signal-safe.
void note_ending_signal(int signal);

/// The signal that was noted last and that nobody has taken, or 0.
int noted_ending_signal();

/// The same, and takes it: nothing is noted any more.
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

}  // namespace mssim
