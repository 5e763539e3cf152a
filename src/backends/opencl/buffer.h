#pragma once

#include <CL/opencl.hpp>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <span>

#include "backends/backend.h"
#include "backends/opencl/device.h"

namespace mssim {

/// An array of T that a device's kernels and the host take turns with.
///
/// In shared memory, on a device that shares the host's, the array lies in aligned host memory and is never
/// copied. On a device with memory of its own it lies there, and the driver copies it whenever the host maps
/// or unmaps it. In copied memory there are two arrays, one on the device and one on the host; mapping and
/// unmapping are the explicit transfers between them.
template <class T>
class OpenclBuffer {
 public:
  OpenclBuffer(const cl::Context& context, const OpenclDevice& device, DeviceMemory memory, std::size_t size)
      : size_(size), copies_(memory == DeviceMemory::copy) {
    // A page: drivers copy what begins or ends within a cache line.
    constexpr std::size_t alignment = 4096;
    const std::size_t bytes = (size * sizeof(T) + alignment - 1) / alignment * alignment;
    if (copies_ || device.shares_host_memory) {
      memory_.reset(static_cast<T*>(std::aligned_alloc(alignment, bytes)));
      if (!memory_) throw std::bad_alloc();
    }
    if (memory_ && !copies_) {
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
    if (!copies_)
      return {static_cast<T*>(queue.enqueueMapBuffer(buffer_, blocking, use, 0, size_ * sizeof(T))), size_};
    if ((use & CL_MAP_READ) != 0) {
      queue.enqueueReadBuffer(buffer_, blocking, 0, size_ * sizeof(T), memory_.get());
    } else if (block) {
      queue.finish();  // an earlier transfer to the device may still be reading
    }
    return {memory_.get(), size_};
  }
  /// Hands what `map` gave back, for the same `use`, to the device, for the work that is queued from now on.
  void unmap(const cl::CommandQueue& queue, std::span<T> mapped, cl_map_flags use) const {
    if (!copies_) {
      queue.enqueueUnmapMemObject(buffer_, mapped.data());
    } else if ((use & CL_MAP_WRITE) != 0) {
      queue.enqueueWriteBuffer(buffer_, CL_FALSE, 0, size_ * sizeof(T), memory_.get());
    }
  }

 private:
  struct Free {
    void operator()(T* memory) const { std::free(memory); }
  };
  std::size_t size_;
  bool copies_;
  std::unique_ptr<T, Free> memory_;  // outlives buffer_, which may refer to it
  cl::Buffer buffer_;
};

}  // namespace mssim
