#include "backends/backends.h"

#include <array>

#include "backends/hybrid.h"
#include "backends/opencl.h"
#include "backends/opencl/device.h"
#include "backends/openmp.h"
#include "backends/serial.h"
#include "backends/threads_mutex.h"

namespace mssim {
namespace {

// On a cloth a band's or plane's padding is nothing to speak of; bodies are cut into slices, whose making
// takes about as much again as what is made.
constexpr MemoryUse bands{.pair_node = 24};
constexpr MemoryUse slices{.node = 90, .pair_node = 32, .storage = Storage::separate, .spring = 34};
constexpr MemoryUse planes{.node = 16, .pair_node = 24, .storage = Storage::separate};
constexpr MemoryUse device_slices{.node = 100, .pair_node = 32, .storage = Storage::separate, .spring = 34};
constexpr MemoryUse packed{.node = 24, .pair_node = 32, .spring = 38};

constexpr std::array<BackendInfo, 5> table{{
    {"serial", "cpu-only", "one thread, spring list: the baseline, and in double precision the reference",
     false, make_serial, spring_list_memory, spring_list_memory},
    {"threads-mutex", "multi-thread-cpu",
     "as published: spring groups per thread, a lock around the accumulation", false, make_threads_mutex,
     spring_list_memory, spring_list_memory},
    {"openmp", "multi-thread-cpu", "vectorised and race-free: the same bits at every thread count", false,
     make_openmp, bands, slices},
    {"opencl", "gpu", "fused stage kernels on an OpenCL device", true, make_opencl, planes, device_slices},
    {"hybrid", "gpu+multi-thread-cpu",
     "OpenCL computes spring forces into shared memory, OpenMP sums and integrates", true, make_hybrid,
     packed, packed},
}};

}  // namespace

std::span<const BackendInfo> backends() { return table; }

const BackendInfo* find_backend(std::string_view name) {
  for (const BackendInfo& backend : table)
    if (backend.name == name) return &backend;
  return nullptr;
}

std::string unavailable_reason(const BackendInfo& backend, const ExecutionOptions& options) {
  if (!backend.uses_device) return "";
  try {
    choose_opencl_device(opencl_devices(), options.device);
  } catch (const Unavailable& reason) {
    return reason.what();
  }
  return "";
}

}  // namespace mssim
