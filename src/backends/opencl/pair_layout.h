#pragma once

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "backends/devices/buffer.h"
#include "backends/devices/device_queue.h"
#include "model/system.h"

namespace mssim {

/// How a topology's nodes lie in the buffer of a pair.
struct PairLayout {
  std::size_t floats = 0;         ///< in the buffer
  std::vector<std::size_t> node;  ///< [nodes] where the node's numbers begin
  /// Where a node's numbers stand besides: where they begin, and the node. Kernels keep them up to date.
  std::vector<std::pair<std::size_t, std::size_t>> copies;
  std::array<std::size_t, 6> component{};  ///< from there on x, y, z, u, v, w
};

/// Writes the state into a buffer of this layout that begins `first` floats into `buffer`. Lets cl::Error
/// through, as the other does.
void write_state(const DeviceQueue& queue, const OpenclBuffer<float>& buffer, const PairLayout& layout,
                 const State& state, std::size_t first = 0);
State read_state(const DeviceQueue& queue, const OpenclBuffer<float>& buffer, const PairLayout& layout);

}  // namespace mssim
