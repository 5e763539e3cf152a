#pragma once

#include <filesystem>
#include <string>

namespace mssim {

/// What PoCL, the driver that makes the processor a device, reads from the environment when it is loaded.

/// Asks PoCL for a core of its own for each of its threads, unless the user has decided that. Between short
/// kernels they sleep, and Linux wakes two of them on one core: the spring forces of 38,233 nodes then took
/// 200 microseconds on two cores, 110 to 150 with this. PoCL numbers cores from 0, so that a process that is
/// kept from some of them must not ask.
void bind_pocl_threads();

/// Where PoCL keeps compiled kernels, without which it offers no device.
struct PoclCache {
  std::string failure;  ///< why the folder that the user chose cannot be written, a sentence; else empty
  std::string note;     ///< what it costs that no lasting folder can be written, a sentence; else empty
};

/// Sees to it that PoCL can write its cache: where it would take a folder by itself that cannot be written,
/// POCL_CACHE_DIR becomes mssim's own in the user's folder for caches or, where that cannot be written
/// either, a temporary one that goes away when the process ends.
PoclCache provide_pocl_cache();

}  // namespace mssim
