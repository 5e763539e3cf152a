#include "platform/available_memory.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <limits>

#include "platform/container_limits.h"

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

std::string in_gigabytes(std::uint64_t bytes, int digits) {
  char text[48];
  std::snprintf(text, sizeof text, "%.*f GB", digits, static_cast<double>(bytes) * 1e-9);
  return text;
}

}  // namespace

std::uint64_t available_memory() {
  const std::uint64_t available = std::min(kernel_available(), limit_available());
  return std::min(available, container_limits().memory_left.value_or(available));
}

std::optional<std::string> memory_shortage(std::uint64_t needed, std::uint64_t available) {
  if (needed <= available) return std::nullopt;
  constexpr int single_bytes = 9;
  int digits = 2;
  while (digits < single_bytes && in_gigabytes(needed, digits) == in_gigabytes(available, digits)) ++digits;
  return "needs at least " + in_gigabytes(needed, digits) + " of memory, but " +
         in_gigabytes(available, digits) + " are available";
}

std::optional<std::string> memory_shortage(std::uint64_t needed) {
  return memory_shortage(needed, available_memory());
}

}  // namespace mssim
