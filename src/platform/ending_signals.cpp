#include "platform/ending_signals.h"

namespace mssim {

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
