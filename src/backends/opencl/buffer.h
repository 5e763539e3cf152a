#pragma once

#include <CL/opencl.hpp>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <span>

namespace mssim {

/// An array of T that a device's kernels and the host take turns with. On a device that shares the host's
/// memory the array lies in aligned host memory and is never copied; elsewhere it lies on the device.
template <class T>
class OpenclBuffer {
 public:
  OpenclBuffer(const cl::Context& context, std::size_t size, bool shares_host_memory) : size_(size) {
    // A page: drivers copy what begins or ends within a cache line.
    constexpr std::size_t alignment = 4096;
    const std::size_t bytes = (size * sizeof(T) + alignment - 1) / alignment * alignment;
    if (shares_host_memory) {
      memory_.reset(static_cast<T*>(std::aligned_alloc(alignment, bytes)));
      if (!memory_) throw std::bad_alloc();
      buffer_ = cl::Buffer(context, CL_MEM_READ_WRITE | CL_MEM_USE_HOST_PTR, bytes, memory_.get());
    } else {
      buffer_ = cl::Buffer(context, CL_MEM_READ_WRITE, bytes);
    }
  }

  const cl::Buffer& buffer() const { return buffer_; }
  std::size_t size() const { return size_; }

  /// Hands the array to the host. Waits for the queue's work when `block`; else it is the host's once a later
  /// blocking call on the same in-order queue has returned. `use`: CL_MAP_READ and/or CL_MAP_WRITE.
  std::span<T> map(const cl::CommandQueue& queue, cl_map_flags use, bool block = true) const {
    return {static_cast<T*>(
                queue.enqueueMapBuffer(buffer_, block ? CL_TRUE : CL_FALSE, use, 0, size_ * sizeof(T))),
            size_};
  }
  /// Hands what `map` gave back to the device, for the work that is queued from now on.
  void unmap(const cl::CommandQueue& queue, std::span<T> mapped) const {
    queue.enqueueUnmapMemObject(buffer_, mapped.data());
  }

 private:
  struct Free {
    void operator()(T* memory) const { std::free(memory); }
  };
  std::size_t size_;
  std::unique_ptr<T, Free> memory_;  // outlives buffer_, which refers to it
  cl::Buffer buffer_;
};

}  // namespace mssim
