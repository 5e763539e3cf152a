#include "platform/interruption.h"

namespace mssim {
namespace {

// What a signal handler may touch has to be global.
volatile std::sig_atomic_t watched_group = 0;
volatile std::sig_atomic_t received_signal = 0;

void end_group(int signal) {
  received_signal = signal;
  if (watched_group > 0) ::kill(-watched_group, SIGKILL);
}

}  // namespace

void throw_if_ending_signal_noted() {
  if (const int signal = take_ending_signal(); signal != 0) throw Interrupted{signal};
}

InterruptionGuard::InterruptionGuard() {
  sigset_t held;
  ::sigemptyset(&held);
  for (const int signal : ending_signals) ::sigaddset(&held, signal);
  ::pthread_sigmask(SIG_BLOCK, &held, &before_);
  watched_group = 0;
  received_signal = 0;
  signals_.emplace(end_group, SA_RESTART);
}

InterruptionGuard::~InterruptionGuard() {
  watched_group = 0;
  signals_.reset();
  ::pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  if (received_signal != 0) std::raise(received_signal);  // came after it was asked for
}

void InterruptionGuard::release_child() const {
  signals_->restore();
  ::pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

void InterruptionGuard::watch(pid_t group) {
  watched_group = group;
  ::pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

void InterruptionGuard::throw_if_interrupted() {
  if (received_signal == 0) return;
  const int signal = received_signal;
  received_signal = 0;
  throw Interrupted{signal};
}

}  // namespace mssim
