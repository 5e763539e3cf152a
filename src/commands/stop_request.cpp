#include "commands/stop_request.h"

#include <unistd.h>

#include <array>
#include <string_view>

#include "mesh/interruption.h"

namespace mssim {
namespace {

constexpr std::array signals{SIGINT, SIGTERM, SIGHUP};
constexpr std::string_view notice =
    "\nmssim: stopping after the measurement or frame under way; a second signal stops at once\n";

// What a signal handler may touch has to be global.
volatile std::sig_atomic_t received = 0;
std::array<struct sigaction, signals.size()> actions_before;

void remember(int signal) {
  received = signal;
  static_cast<void>(!::write(STDERR_FILENO, notice.data(), notice.size()));
}

}  // namespace

StopRequest::StopRequest() {
  received = 0;
  for (std::size_t i = 0; i < signals.size(); ++i) {
    ::sigaction(signals[i], nullptr, &actions_before[i]);
    if (actions_before[i].sa_handler == SIG_IGN) continue;
    struct sigaction action {};
    action.sa_handler = remember;
    action.sa_flags = static_cast<int>(SA_RESTART | SA_RESETHAND);
    ::sigaction(signals[i], &action, nullptr);
  }
}

StopRequest::~StopRequest() {
  for (std::size_t i = 0; i < signals.size(); ++i) ::sigaction(signals[i], &actions_before[i], nullptr);
  if (received != 0) std::raise(received);
}

bool StopRequest::requested() const { return received != 0; }

void StopRequest::throw_if_requested() {
  if (received == 0) return;
  const int signal = received;
  received = 0;
  throw Interrupted{signal};
}

}  // namespace mssim
