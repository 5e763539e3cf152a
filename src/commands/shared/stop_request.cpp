#include "commands/shared/stop_request.h"

#include <unistd.h>

#include <string_view>

#include "platform/interruption.h"
#include "platform/temporary_folder.h"

namespace mssim {
namespace {

constexpr std::string_view notice =
    "\nmssim: stopping after the current measurement or frame; a second signal stops at once\n";

// What a signal handler may touch has to be global.
volatile std::sig_atomic_t received = 0;

void remember(int signal) {
  received = signal;
  static_cast<void>(!::write(STDERR_FILENO, notice.data(), notice.size()));
}

}  // namespace

StopRequest::StopRequest() : signals_(remember, static_cast<int>(SA_RESTART | SA_RESETHAND)) {}

StopRequest::~StopRequest() {
  signals_.restore();
  if (received == 0) return;
  const int signal = received;
  received = 0;
  remove_temporary_folder_of_process();
  std::raise(signal);
}

bool StopRequest::requested() const { return received != 0; }

void StopRequest::throw_if_requested() {
  if (received == 0) return;
  const int signal = received;
  received = 0;
  throw Interrupted{signal};
}

}  // namespace mssim
