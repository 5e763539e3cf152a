#pragma once

#include <array>
#include <csignal>

namespace mssim {

/// The signals by which a user ends a program: Ctrl-C, kill, a closed terminal.
inline constexpr std::array ending_signals{SIGINT, SIGTERM, SIGHUP};

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
