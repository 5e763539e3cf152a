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

constexpr std::array<BackendInfo, 5> table{{
    {"serial", "cpu-only", "one thread, spring list: the baseline, and in double precision the reference",
     false, make_serial},
    {"threads-mutex", "multi-thread-cpu",
     "as published: spring groups per thread, a lock around the accumulation", false, make_threads_mutex},
    {"openmp", "multi-thread-cpu", "vectorised and race-free: the same bits at every thread count", false,
     make_openmp},
    {"opencl", "gpu", "fused stage kernels on an OpenCL device", true, make_opencl},
    {"hybrid", "gpu+multi-thread-cpu",
     "OpenCL computes spring forces into shared memory, OpenMP sums and integrates", true, make_hybrid},
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
