#include "backends/layouts/aligned_array.h"

#include <sys/mman.h>

#include <new>

namespace mssim {

AlignedArray::AlignedArray(std::size_t size) : size_(size) {
  constexpr std::size_t huge_page = std::size_t{2} << 20;
  const std::size_t page = size * sizeof(float) >= huge_page ? huge_page : alignment;
  const std::size_t bytes = (size * sizeof(float) + page - 1) / page * page;
  if (bytes == 0) return;
  void* memory = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) throw std::bad_alloc();
  if (page == huge_page)
    madvise(memory, bytes, MADV_HUGEPAGE);  // a wish: without it the array is as good, only slower
  data_ = {static_cast<float*>(memory), Unmap{bytes}};
}

void AlignedArray::Unmap::operator()(float* data) const { munmap(data, bytes); }

}  // namespace mssim
