#include "backends/backends.h"

#include <algorithm>
#include <array>

#include "backends/hybrid.h"
#include "backends/opencl.h"
#include "backends/opencl/offer.h"
#include "backends/openmp.h"
#include "backends/serial.h"
#include "backends/threads_mutex.h"

namespace mssim {
namespace {

// On a cloth a band's or plane's padding is nothing to speak of; bodies are cut into slices, whose making
// takes about as much again as what is made. Those with a device read a state back into arrays that grow,
// which takes some 40 bytes a node beside the state. tests/bench_memory_test.cpp holds these against what is
// really taken.
constexpr MemoryUse bands{.node = 24};  // all pairs but the state are a few columns
constexpr MemoryUse slices{.node = 130, .pair_node = 32, .storage = Storage::separate, .spring = 38};
constexpr MemoryUse planes{.node = 56, .pair_node = 24, .storage = Storage::separate};
constexpr MemoryUse device_slices{.node = 130, .pair_node = 32, .storage = Storage::separate, .spring = 38};
constexpr MemoryUse packed{.node = 64, .pair_node = 32, .spring = 50};

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

bool dresses(const BackendInfo& backend) {
  constexpr std::array<std::string_view, 3> those{"serial", "openmp", "opencl"};
  return std::ranges::find(those, backend.name) != those.end();
}

std::string unavailable_reason(const BackendInfo& backend, const ExecutionOptions& options) {
  if (!backend.uses_device) return "";
  try {
    find_opencl_device(options.device);
  } catch (const Unavailable& reason) {
    return reason.what();
  }
  return "";
}

std::string excess_of(const Backend& backend, int threads) {
  if (backend.threads() <= threads) return "";
  return "on " + std::to_string(backend.threads()) + " processors instead of " + std::to_string(threads) +
         ": the driver of " + backend.device() + " cannot divide it";
}

}  // namespace mssim
