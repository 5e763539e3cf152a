#include "platform/ending_signals.h"

namespace mssim {
namespace {

// What a signal handler may touch has to be global.
volatile std::sig_atomic_t noted = 0;

}  // namespace

void note_ending_signal(int signal) { noted = signal; }

int noted_ending_signal() { return noted; }

int take_ending_signal() {
  const int signal = noted;
  noted = 0;
  return signal;
}

EndingSignals::EndingSignals(void (*handler)(int signal), int flags) {
  for (std::size_t i = 0; i < ending_signals.size(); ++i) {
    ::sigaction(ending_signals[i], nullptr, &before_[i]);
    if (before_[i].sa_handler == SIG_IGN) continue;
    struct sigaction action {};
    action.sa_handler = handler;
    action.sa_flags = flags;
    ::sigaction(ending_signals[i], &action, nullptr);
  }
}

void EndingSignals::restore() const {
  for (std::size_t i = 0; i < ending_signals.size(); ++i)
    ::sigaction(ending_signals[i], &before_[i], nullptr);
}

}  // namespace mssim
