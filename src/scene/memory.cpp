#include "scene/memory.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <limits>
#include <string>

#include "scene/scene_error.h"

namespace mssim {
namespace {

/// MemAvailable of /proc/meminfo; all there could be where the kernel does not say.
std::uint64_t kernel_available() {
  std::ifstream meminfo("/proc/meminfo");
  for (std::string key; meminfo >> key;) {
    std::uint64_t kibibytes = 0;
    if (key == "MemAvailable:" && meminfo >> kibibytes) return kibibytes * 1024;
    meminfo.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  }
  return std::numeric_limits<std::uint64_t>::max();
}

/// What the address-space limit leaves.
std::uint64_t limit_available() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
    return std::numeric_limits<std::uint64_t>::max();
  std::uint64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  const std::uint64_t used = pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
  return limit.rlim_cur > used ? limit.rlim_cur - used : 0;
}

std::string in_gigabytes(std::uint64_t bytes) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f GB", static_cast<double>(bytes) * 1e-9);
  return text;
}

}  // namespace

std::uint64_t memory_needed(std::uint64_t nodes, std::uint64_t springs) {
  constexpr std::uint64_t start = 1, reference_pairs = 4, read_back = 1;
  return nodes * (start + reference_pairs + read_back) * 2 * sizeof(Vec3d) + springs * sizeof(Spring);
}

std::uint64_t memory_available() { return std::min(kernel_available(), limit_available()); }

void require_memory(const SceneSpec& spec, std::string_view pointer, const SceneCounts& counts,
                    std::uint64_t needed, std::string_view remedy) {
  const std::uint64_t available = memory_available();
  if (needed <= available) return;
  refuse(spec.file, pointer,
         "has " + std::to_string(counts.nodes) + " nodes and " + std::to_string(counts.springs_unique) +
             " springs and needs at least " + in_gigabytes(needed) + " of memory, but " +
             in_gigabytes(available) + " are available: " + std::string(remedy));
}

}  // namespace mssim
