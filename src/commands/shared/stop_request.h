#pragma once

#include "platform/process.h"

namespace mssim {

/// While it lives, a first ending signal (platform/process.h) is remembered, and told on stderr, so
/// that what is under way can be finished and written; a second one ends the program at once. Signals that
/// are ignored (nohup) stay so. One at a time.
class StopRequest {
 public:
  StopRequest();
  /// A signal that nobody asked for ends the program now.
  ~StopRequest();
  StopRequest(const StopRequest&) = delete;
  StopRequest& operator=(const StopRequest&) = delete;

  /// Whether a signal has come.
  bool requested() const;
  /// Throws Interrupted when one has.
  void throw_if_requested();

 private:
  EndingSignals signals_;
};

}  // namespace mssim
