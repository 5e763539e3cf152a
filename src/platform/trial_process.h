#pragma once

#include <functional>

namespace mssim {

/// Does `work` in a process of its own, a copy of this one, and says whether it came to an end: a library
/// that crashes, or does not end within `most_seconds` of processor time, then ends that process alone. What
/// `work` throws counts as an end, and what it prints is lost. True where no process can be made. Only this
/// thread is in the copy: `work` must not need others.
bool ends_in_trial(const std::function<void()>& work, unsigned most_seconds);

}  // namespace mssim
