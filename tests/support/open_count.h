#pragma once

#include <sys/inotify.h>
#include <unistd.h>

#include <cstring>

#include "platform/process.h"
#include "tests/support/testing.h"

namespace mssim {

/// Counts how often a file is opened from now on.
class OpenCount {
 public:
  explicit OpenCount(const std::filesystem::path& file) : queue_(::inotify_init1(IN_NONBLOCK | IN_CLOEXEC)) {
    // Events that are alike and follow each other would be told as one; between two openings there is a
    // closing.
    if (::inotify_add_watch(queue_.get(), file.c_str(), IN_OPEN | IN_CLOSE) < 0)
      throw std::runtime_error("cannot watch " + file.string());
  }

  /// Openings since it was asked last.
  int value() {
    int opened = 0;
    std::array<char, 4096> events{};
    ssize_t size = 0;
    while ((size = ::read(queue_.get(), events.data(), events.size())) > 0)
      for (std::size_t at = 0; at < static_cast<std::size_t>(size);) {
        inotify_event event{};
        std::memcpy(&event, events.data() + at, sizeof event);
        if (event.mask & IN_OPEN) ++opened;
        at += sizeof event + event.len;
      }
    return opened;
  }

 private:
  Descriptor queue_;
};

}  // namespace mssim
