#pragma once

#include <CL/opencl.hpp>
#include <algorithm>
#include <cstddef>
#include <span>
#include <string>

#include "backends/devices/buffer.h"
#include "backends/devices/device.h"
#include "backends/devices/program.h"
#include "backends/devices/sub_device.h"
#include "backends/devices/work_items.h"
#include "backends/interface/backend.h"

namespace mssim {

/// A kernel whose arguments are set.
struct Launch {
  cl::Kernel kernel;
  WorkItems items;
};

/// A device as one backend uses it: arrays that host and device take turns with, programs, and a queue of
/// launches, one behind the other. All of it lets cl::Error through.
class DeviceQueue {
 public:
  DeviceQueue(const OpenclDevice& device, DeviceMemory memory)
      : device_(device),
        memory_(memory),
        context_(cl::Device(device.id, true)),
        commands_(context_, cl::Device(device.id, true)) {}

  /// What an OpenclBuffer is mapped, unmapped and written with.
  const cl::CommandQueue& commands() const { return commands_; }

  /// An array; of one element where `size` is 0, because OpenCL has no empty ones.
  template <class T>
  OpenclBuffer<T> array(std::size_t size) const {
    return {context_, device_, memory_, std::max<std::size_t>(1, size)};
  }
  template <class T>
  OpenclBuffer<T> zeros(std::size_t size) const {
    auto buffer = array<T>(size);
    buffer.write(commands_, [](std::span<T> values) { std::ranges::fill(values, T{}); });
    return buffer;
  }
  template <class T>
  OpenclBuffer<T> copy_of(std::span<const T> values) const {
    auto buffer = array<T>(values.size());
    buffer.write(commands_, [&](std::span<T> copy) { std::ranges::copy(values, copy.begin()); });
    return buffer;
  }

  /// See build_program.
  cl::Program build(const std::string& text) const {
    return build_program(context_, cl::Device(device_.id, true), text);
  }

  void launch(const Launch& launch) const {
    commands_.enqueueNDRangeKernel(launch.kernel, cl::NullRange, launch.items.global, launch.items.local);
  }
  /// Takes steps, each of the launches that `launches_of(step)` gives, and waits for the last one.
  template <class LaunchesOf>
  void take_steps(int count, const LaunchesOf& launches_of) const {
    std::size_t queued = 0;
    for (int step = 0; step < count; ++step)
      for (const Launch& each : launches_of(step)) {
        launch(each);
        if (++queued % longest_queue == 0) commands_.finish();
      }
    commands_.finish();
  }

  /// What a backend says about where its steps run (Backend::device, threads, runs_on_host).
  std::string label() const { return label_of(device_, memory_); }
  int threads() const { return threads_of(device_); }
  bool runs_on_host() const { return device_.type == OpenclDeviceType::cpu; }

 private:
  /// Launches between two waits for the queue to run empty: waiting is rare enough to cost nothing, and a
  /// driver never has to hold more unfinished commands than this.
  static constexpr std::size_t longest_queue = 256;

  OpenclDevice device_;
  DeviceMemory memory_;
  cl::Context context_;
  cl::CommandQueue commands_;
};

/// Takes some steps and then stands at `start`: drivers finish compiling at a kernel's first launch with a
/// range.
template <class Stepped>
void warm_up(Stepped& backend, const State& start, int steps) {
  backend.set_state(start);
  backend.step(steps);
  backend.set_state(start);
}

}  // namespace mssim
