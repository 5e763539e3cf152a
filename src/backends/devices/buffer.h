#pragma once

#include <sys/mman.h>

#include <CL/opencl.hpp>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <memory>
#include <new>
#include <span>

#include "backends/devices/device.h"
#include "backends/interface/backend.h"

namespace mssim {

/// An array of T that a device's kernels and the host take turns with.
///
/// In shared memory, on a device that shares the host's, the array lies in aligned host memory and is never
/// copied; where the device can, it is fine-grained shared virtual memory, and taking turns costs no command
/// in the queue: a step of hybrid on bodies38233 takes 0.8 of the time. On a device with memory of its own it
/// lies there, and the driver copies it whenever the host maps or unmaps it. In copied memory there are two
/// arrays, one on the device and one on the host; mapping and unmapping are the explicit transfers between
/// them.
template <class T>
class OpenclBuffer {
 public:
  OpenclBuffer(const cl::Context& context, const OpenclDevice& device, DeviceMemory memory, std::size_t size)
      : size_(size),
        exchange_(memory == DeviceMemory::copy                     ? Exchange::copies
                  : device.host_memory == HostMemory::fine_grained ? Exchange::nothing
                                                                   : Exchange::maps) {
    // Whole pages, because drivers copy what begins or ends within a cache line.
    constexpr std::size_t page = 4096, huge_page = std::size_t{2} << 20;
    const std::size_t alignment = size * sizeof(T) >= huge_page ? huge_page : page;
    const std::size_t bytes = (size * sizeof(T) + alignment - 1) / alignment * alignment;
    if (exchange_ == Exchange::copies || device.host_memory != HostMemory::none) {
      memory_ = exchange_ == Exchange::nothing ? shared_virtual_memory(context, bytes)
                                               : host_memory(alignment, bytes);
      if (!memory_) throw std::bad_alloc();
      aligned(memory_.get());
      if (alignment == huge_page) wish_for_huge_pages(memory_.get(), bytes);
    }
    // A buffer made of shared virtual memory is that memory (The OpenCL Specification, 3.0, clCreateBuffer).
    if (memory_ && exchange_ != Exchange::copies) {
      buffer_ = cl::Buffer(context, CL_MEM_READ_WRITE | CL_MEM_USE_HOST_PTR, bytes, memory_.get());
    } else {
      buffer_ = cl::Buffer(context, CL_MEM_READ_WRITE, bytes);
    }
  }

  const cl::Buffer& buffer() const { return buffer_; }
  std::size_t size() const { return size_; }

  /// Hands the array to the host. Waits for the queue's work when `block`; else it is the host's once a later
  /// blocking call on the same in-order queue has returned. `use`: CL_MAP_READ and/or CL_MAP_WRITE. With
  /// CL_MAP_READ the host sees what kernels wrote; without it, it may not read what they wrote, and finds
  /// everything else as it left it.
  std::span<T> map(const cl::CommandQueue& queue, cl_map_flags use, bool block = true) const {
    const cl_bool blocking = block ? CL_TRUE : CL_FALSE;
    if (exchange_ == Exchange::maps)
      return {aligned(queue.enqueueMapBuffer(buffer_, blocking, use, 0, size_ * sizeof(T))), size_};
    if (exchange_ == Exchange::copies && (use & CL_MAP_READ) != 0) {
      queue.enqueueReadBuffer(buffer_, blocking, 0, size_ * sizeof(T), memory_.get());
    } else if (block) {
      queue.finish();  // kernels, or an earlier transfer to the device, may still be reading
    }
    return {memory_.get(), size_};
  }
  /// Hands what `map` gave back, for the same `use`, to the device, for the work that is queued from now on.
  void unmap(const cl::CommandQueue& queue, std::span<T> mapped, cl_map_flags use) const {
    if (exchange_ == Exchange::maps) queue.enqueueUnmapMemObject(buffer_, mapped.data());
    if (exchange_ == Exchange::copies && (use & CL_MAP_WRITE) != 0)
      queue.enqueueWriteBuffer(buffer_, CL_FALSE, 0, size_ * sizeof(T), memory_.get());
  }
  /// Lets `fill` write the array, a std::span<T>, while the device has nothing to do with it.
  template <class Fill>
  void write(const cl::CommandQueue& queue, Fill&& fill) const {
    const std::span<T> array = map(queue, CL_MAP_WRITE);
    fill(array);
    unmap(queue, array, CL_MAP_WRITE);
    queue.finish();
  }

 private:
  /// What taking turns takes.
  enum class Exchange : std::uint8_t { copies, maps, nothing };
  using Memory = std::unique_ptr<T, std::function<void(T*)>>;

  static Memory host_memory(std::size_t alignment, std::size_t bytes) {
    return {static_cast<T*>(std::aligned_alloc(alignment, bytes)), [](T* memory) { std::free(memory); }};
  }
  static Memory shared_virtual_memory(const cl::Context& context, std::size_t bytes) {
    constexpr cl_svm_mem_flags flags = CL_MEM_READ_WRITE | CL_MEM_SVM_FINE_GRAIN_BUFFER;
    return {static_cast<T*>(clSVMAlloc(context(), flags, bytes, 0)),
            [context](T* memory) { clSVMFree(context(), memory); }};
  }
  /// What the driver gave, if vectors can be loaded from it. OpenCL promises more, but not every driver keeps
  /// it.
  static T* aligned(void* memory) {
    constexpr std::uintptr_t vector_bytes = 64;
    if (reinterpret_cast<std::uintptr_t>(memory) % vector_bytes != 0)
      throw Unavailable(
          "the OpenCL driver gives the host memory that is not aligned to 64 bytes; use --memory copy");
    return static_cast<T*>(memory);
  }
  /// Without them the array is only slower. For the whole pages of it.
  static void wish_for_huge_pages(T* memory, std::size_t bytes) {
    constexpr std::uintptr_t page = 4096;
    const auto address = reinterpret_cast<std::uintptr_t>(memory);
    const std::uintptr_t begin = (address + page - 1) / page * page, end = (address + bytes) / page * page;
    madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
  }

  std::size_t size_;
  Exchange exchange_;
  Memory memory_;  // outlives buffer_, which may refer to it
  cl::Buffer buffer_;
};

}  // namespace mssim
