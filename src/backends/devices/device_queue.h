#pragma once

#include <sys/mman.h>

#include <CL/opencl.hpp>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <initializer_list>
#include <memory>
#include <new>
#include <span>
#include <string>
#include <utility>

#include "backends/devices/device.h"
#include "backends/devices/drivers.h"

namespace mssim {

/// Does `work`; if an OpenCL call in it fails, throws Failure with one sentence.
template <class Failure, class Work>
auto opencl_call(Work&& work) {
  try {
    return std::forward<Work>(work)();
  } catch (const cl::Error& error) {
    throw Failure(opencl_failure(error.what(), error.err()));
  }
}

/// Text of the files in kernels/, in this order, for `lanes` nodes or springs in one Real (1, 4, 8 or 16).
/// The rest of a program must depend only on the integrator, so that a driver's cache of built programs
/// serves every scene. Throws std::runtime_error if a file is missing.
std::string program_text(int lanes, std::initializer_list<const char*> files);
/// The program text for nodes in slices of `slice_nodes`.
std::string slices_program_text(std::size_t slice_nodes, int lanes, std::initializer_list<const char*> files);

/// An array of T that a device's kernels and the host use in turn.
///
/// In shared memory, on a device that shares the host's memory, the array is in aligned host memory and is
/// never copied; if the device supports it, it is fine-grained shared virtual memory, and changing hands
/// needs no command in the queue. With PoCL, such commands took a fifth of a step of hybrid on bodies38233.
/// On a device with its own memory the array is there, and the driver copies it when the host maps or unmaps
/// it. In copied memory there are two arrays, one on the device and one on the host; mapping and unmapping
/// are the explicit transfers between them.
template <class T>
class OpenclBuffer {
 public:
  /// `queue`: in-order, for the device work that alternates with the host.
  OpenclBuffer(const cl::Context& context, const cl::CommandQueue& queue, const OpenclDevice& device,
               DeviceMemory memory, std::size_t size)
      : queue_(queue),
        size_(size),
        exchange_(memory == DeviceMemory::copy                     ? Exchange::copies
                  : device.host_memory == HostMemory::fine_grained ? Exchange::nothing
                                                                   : Exchange::maps) {
    // Whole pages, because drivers copy arrays that begin or end within a cache line.
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
    // A buffer made from shared virtual memory is that memory (The OpenCL Specification, 3.0,
    // clCreateBuffer).
    if (memory_ && exchange_ != Exchange::copies) {
      buffer_ = cl::Buffer(context, CL_MEM_READ_WRITE | CL_MEM_USE_HOST_PTR, bytes, memory_.get());
    } else {
      buffer_ = cl::Buffer(context, CL_MEM_READ_WRITE, bytes);
    }
  }

  const cl::Buffer& buffer() const { return buffer_; }
  std::size_t size() const { return size_; }

  /// Hands the array to the host. Waits for the queue's work if `block`; otherwise the host may use it after
  /// a later blocking call on the same queue. `use`: CL_MAP_READ and/or CL_MAP_WRITE. With CL_MAP_READ the
  /// host sees what kernels wrote; without it, it must not read that, and finds everything else unchanged.
  std::span<T> map(cl_map_flags use, bool block = true) const {
    const cl_bool blocking = block ? CL_TRUE : CL_FALSE;
    if (exchange_ == Exchange::maps)
      return {aligned(queue_.enqueueMapBuffer(buffer_, blocking, use, 0, size_ * sizeof(T))), size_};
    if (exchange_ == Exchange::copies && (use & CL_MAP_READ) != 0) {
      queue_.enqueueReadBuffer(buffer_, blocking, 0, size_ * sizeof(T), memory_.get());
    } else if (block) {
      queue_.finish();  // kernels, or an earlier transfer to the device, may still read
    }
    return {memory_.get(), size_};
  }
  /// Hands the array from `map` with the same `use` back to the device, for work queued from now on.
  void unmap(std::span<T> mapped, cl_map_flags use) const {
    if (exchange_ == Exchange::maps) queue_.enqueueUnmapMemObject(buffer_, mapped.data());
    if (exchange_ == Exchange::copies && (use & CL_MAP_WRITE) != 0)
      queue_.enqueueWriteBuffer(buffer_, CL_FALSE, 0, size_ * sizeof(T), memory_.get());
  }
  /// Lets `fill` write the array, a std::span<T>, while the device does not use it.
  template <class Fill>
  void write(Fill&& fill) const {
    const std::span<T> array = map(CL_MAP_WRITE);
    fill(array);
    unmap(array, CL_MAP_WRITE);
    queue_.finish();
  }
  /// Returns the result of `look` on the array, a std::span<const T>, while the device does not use it.
  template <class Look>
  auto read(Look&& look) const {
    const std::span<T> array = map(CL_MAP_READ);
    auto seen = look(std::span<const T>(array));
    unmap(array, CL_MAP_READ);
    queue_.finish();
    return seen;
  }

 private:
  /// Command that changing hands needs.
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
  /// The driver's memory, if vectors can be loaded from it: not every driver gives the alignment that OpenCL
  /// requires.
  static T* aligned(void* memory) {
    constexpr std::uintptr_t vector_bytes = 64;
    if (reinterpret_cast<std::uintptr_t>(memory) % vector_bytes != 0)
      throw Unavailable(
          "the OpenCL driver gives the host memory that is not aligned to 64 bytes; use --memory copy");
    return static_cast<T*>(memory);
  }
  /// Requests huge pages for the array's whole pages; without them it is only slower.
  static void wish_for_huge_pages(T* memory, std::size_t bytes) {
    constexpr std::uintptr_t page = 4096;
    const auto address = reinterpret_cast<std::uintptr_t>(memory);
    const std::uintptr_t begin = (address + page - 1) / page * page, end = (address + bytes) / page * page;
    madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
  }

  cl::CommandQueue queue_;
  std::size_t size_;
  Exchange exchange_;
  Memory memory_;  // outlives buffer_, which may refer to it
  cl::Buffer buffer_;
};

/// Work-items of a launch, a multiple of those of a group.
struct WorkItems {
  cl::NDRange global, local;
};

/// How the work-items of a launch share work in chunks of `lanes` nodes or springs. On a CPU, where a
/// work-item has several lanes, few work-items take many chunks in turn, but enough that others take over
/// part of a delayed one's share. With one lane, each work-item takes one chunk.
struct OpenclChunks {
  WorkItems items;
  std::size_t per_item = 0;  ///< chunks per work-item

  OpenclChunks(std::size_t chunks, const OpenclDevice& device, int lanes) {
    constexpr std::size_t good_items_per_unit = 16, good_group = 64;
    const bool wide = lanes > 1;
    const std::size_t local = wide ? 1 : good_group;
    per_item = wide ? std::max<std::size_t>(1, chunks / (good_items_per_unit * device.compute_units)) : 1;
    items = {cl::NDRange(((chunks + per_item - 1) / per_item + local - 1) / local * local),
             cl::NDRange(local)};
  }
};

/// A kernel with its arguments set.
struct Launch {
  cl::Kernel kernel;
  WorkItems items;
};

/// A device as used by one backend: arrays that host and device use in turn, programs, and a queue of
/// launches in order. All functions may throw cl::Error.
class DeviceQueue {
 public:
  DeviceQueue(const OpenclDevice& device, DeviceMemory memory)
      : device_(device),
        memory_(memory),
        context_(cl::Device(device.id, true)),
        commands_(context_, cl::Device(device.id, true)) {}

  /// An array; of one element if `size` is 0, because OpenCL has no empty ones.
  template <class T>
  OpenclBuffer<T> array(std::size_t size) const {
    return {context_, commands_, device_, memory_, std::max<std::size_t>(1, size)};
  }
  template <class T>
  OpenclBuffer<T> zeros(std::size_t size) const {
    auto buffer = array<T>(size);
    buffer.write([](std::span<T> values) { std::ranges::fill(values, T{}); });
    return buffer;
  }
  template <class T>
  OpenclBuffer<T> copy_of(std::span<const T> values) const {
    auto buffer = array<T>(values.size());
    buffer.write([&](std::span<T> copy) { std::ranges::copy(values, copy.begin()); });
    return buffer;
  }

  /// The built program. Square roots and divisions are correctly rounded if the device supports it. Throws
  /// Unavailable with the compiler's first error.
  cl::Program build(const std::string& text) const;

  void launch(const Launch& launch) const {
    commands_.enqueueNDRangeKernel(launch.kernel, cl::NullRange, launch.items.global, launch.items.local);
  }
  /// Waits for all launches.
  void finish() const { commands_.finish(); }
  /// Takes steps, each with the launches of `launches_of(step)`, and waits for the last one.
  template <class LaunchesOf>
  void take_steps(int count, const LaunchesOf& launches_of) const {
    std::size_t queued = 0;
    for (int step = 0; step < count; ++step)
      for (const Launch& each : launches_of(step)) {
        launch(each);
        if (++queued % longest_queue == 0) finish();
      }
    finish();
  }

  /// Answers of a backend about where its steps run (Backend::device, threads, runs_on_host).
  std::string label() const {
    return memory_ == DeviceMemory::copy ? device_.name + " (copied memory)" : device_.name;
  }
  int threads() const { return threads_of(device_); }
  bool runs_on_host() const { return device_.type == OpenclDeviceType::cpu; }

 private:
  /// Launches between two waits for an empty queue: waits are rare enough to cost nothing, and a driver never
  /// has more unfinished commands than this.
  static constexpr std::size_t longest_queue = 256;

  OpenclDevice device_;
  DeviceMemory memory_;
  cl::Context context_;
  cl::CommandQueue commands_;
};

/// Takes some steps and then returns to `start`: drivers finish compiling at a kernel's first launch with a
/// range.
template <class Stepped>
void warm_up(Stepped& backend, const State& start, int steps) {
  const CompileTimer timer;
  backend.set_state(start);
  backend.step(steps);
  backend.set_state(start);
}

}  // namespace mssim
