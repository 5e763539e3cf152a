#pragma once

#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstddef>

namespace mssim {

inline constexpr int new_pages = 1000;

/// Writes to as many pages of memory that were never used: a page fault each. Sanitizers do not see it,
/// because they would use further memory. Without memory there are no faults.
__attribute__((no_sanitize("address", "thread"))) inline void touch_new_pages() {
  const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  const std::size_t size = new_pages * page;
  // Not from the heap, which may have pages that are in use, or large ones.
  const long address =
      ::syscall(SYS_mmap, nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0L);
  if (address == -1) return;
  auto* const memory = reinterpret_cast<volatile char*>(address);
  ::syscall(SYS_madvise, memory, size, MADV_NOHUGEPAGE);
  for (std::size_t i = 0; i < size; i += page) memory[i] = 1;
  ::syscall(SYS_munmap, memory, size);
}

}  // namespace mssim
