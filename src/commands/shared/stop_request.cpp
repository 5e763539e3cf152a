#include "commands/shared/stop_request.h"

#include <unistd.h>

#include <string_view>

#include "platform/files.h"
#include "platform/process.h"

namespace mssim {
namespace {

constexpr std::string_view notice =
    "\nmssim: stopping after the current measurement or frame; a second signal stops at once\n";

void remember(int signal) {
  note_ending_signal(signal);
  static_cast<void>(!::write(STDERR_FILENO, notice.data(), notice.size()));
}

}  // namespace

StopRequest::StopRequest() : signals_(remember, static_cast<int>(SA_RESTART | SA_RESETHAND)) {}

StopRequest::~StopRequest() {
  signals_.restore();
  const int signal = take_ending_signal();
  if (signal == 0) return;
  remove_temporary_folder_of_process();
  std::raise(signal);
}

bool StopRequest::requested() const { return noted_ending_signal() != 0; }

void StopRequest::throw_if_requested() { throw_if_ending_signal_noted(); }

}  // namespace mssim
