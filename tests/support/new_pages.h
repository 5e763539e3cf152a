#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>

namespace mssim {

inline constexpr int new_pages = 1000;

/// Writes to as many pages of memory that were never used: a page fault each. Throws nothing: without memory
/// there are no faults.
inline void touch_new_pages() {
  const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  const std::size_t size = new_pages * page;
  // Not from the heap, which may have pages that are in use, or large ones.
  void* memory = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) return;
  ::madvise(memory, size, MADV_NOHUGEPAGE);
  for (std::size_t i = 0; i < size; i += page) static_cast<volatile char*>(memory)[i] = 1;
  ::munmap(memory, size);
}

}  // namespace mssim
