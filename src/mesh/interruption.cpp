#include "mesh/interruption.h"

#include <array>

namespace mssim {
namespace {

constexpr std::array signals{SIGINT, SIGTERM, SIGHUP};

// What a signal handler may touch has to be global.
volatile std::sig_atomic_t watched_group = 0;
volatile std::sig_atomic_t received = 0;
std::array<struct sigaction, signals.size()> actions_before;

void end_group(int signal) {
  received = signal;
  if (watched_group > 0) ::kill(-watched_group, SIGKILL);
}

void restore_actions() {
  for (std::size_t i = 0; i < signals.size(); ++i) ::sigaction(signals[i], &actions_before[i], nullptr);
}

}  // namespace

InterruptionGuard::InterruptionGuard() {
  sigset_t held;
  ::sigemptyset(&held);
  for (const int signal : signals) ::sigaddset(&held, signal);
  ::pthread_sigmask(SIG_BLOCK, &held, &before_);
  watched_group = 0;
  received = 0;
  for (std::size_t i = 0; i < signals.size(); ++i) {
    ::sigaction(signals[i], nullptr, &actions_before[i]);
    if (actions_before[i].sa_handler == SIG_IGN) continue;
    struct sigaction action {};
    action.sa_handler = end_group;
    action.sa_flags = SA_RESTART;
    ::sigaction(signals[i], &action, nullptr);
  }
}

InterruptionGuard::~InterruptionGuard() {
  watched_group = 0;
  restore_actions();
  ::pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  if (received != 0) std::raise(received);  // came after it was asked for
}

void InterruptionGuard::release_child() const {
  restore_actions();
  ::pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

void InterruptionGuard::watch(pid_t group) {
  watched_group = group;
  ::pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

void InterruptionGuard::throw_if_interrupted() {
  if (received == 0) return;
  const int signal = received;
  received = 0;
  throw Interrupted{signal};
}

}  // namespace mssim
