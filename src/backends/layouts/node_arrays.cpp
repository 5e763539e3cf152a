#include "backends/layouts/node_arrays.h"

#include <sys/mman.h>

#include <algorithm>
#include <new>

namespace mssim {

AlignedArray::AlignedArray(std::size_t size) : size_(size) {
  constexpr std::size_t huge_page = std::size_t{2} << 20;
  const std::size_t page = size * sizeof(float) >= huge_page ? huge_page : alignment;
  const std::size_t bytes = round_up(size * sizeof(float), page);
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
  data_ = {static_cast<float*>(memory), Unmap{mapped}};
}

void AlignedArray::Unmap::operator()(float* data) const { munmap(data, bytes); }

void write_records(const State& state, std::span<const std::uint32_t> slot, float* records) {
  for (std::size_t node = 0; node < slot.size(); ++node) {
    const Vec3<float> x = vec3_cast<float>(state.position[node]), v = vec3_cast<float>(state.velocity[node]);
    const std::array<float, record_floats> record{x.x, x.y, x.z, 0, v.x, v.y, v.z, 0};
    std::copy(record.begin(), record.end(), records + std::size_t{slot[node]} * record_floats);
  }
}

State read_records(const float* records, std::span<const std::uint32_t> slot) {
  State state;
  for (const std::uint32_t number : slot) {
    const float* record = records + std::size_t{number} * record_floats;
    state.position.push_back({record[0], record[1], record[2]});
    state.velocity.push_back({record[4], record[5], record[6]});
  }
  return state;
}

}  // namespace mssim
