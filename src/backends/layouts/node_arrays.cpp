#include "backends/layouts/node_arrays.h"

#include <sys/mman.h>

#include <new>

namespace mssim {

template <class Real>
AlignedArrayOf<Real>::AlignedArrayOf(std::size_t size) : size_(size) {
  constexpr std::size_t huge_page = std::size_t{2} << 20;
  const std::size_t page = size * sizeof(Real) >= huge_page ? huge_page : alignment;
  const std::size_t bytes = round_up(size * sizeof(Real), page);
  if (bytes == 0) return;
  // The system maps one array directly below another, and a hardware prefetcher continues across the end of a
  // page: it would take the beginning of one array out of the cache of the thread that writes it, for a
  // thread that reads the end of the array below. So an unused page follows each array; it is of the same
  // kind, so that the memory below also stays on such a page.
  const std::size_t mapped = bytes + page;
  void* memory = mmap(nullptr, mapped, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) throw std::bad_alloc();
  if (page == huge_page)
    madvise(memory, bytes, MADV_HUGEPAGE);  // only a hint: without it the array is slower
  data_ = {static_cast<Real*>(memory), Unmap{mapped}};
}

template <class Real>
void AlignedArrayOf<Real>::Unmap::operator()(Real* data) const {
  munmap(data, bytes);
}

template class AlignedArrayOf<float>;
template class AlignedArrayOf<double>;

}  // namespace mssim
