#pragma once

#include <CL/opencl.hpp>
#include <algorithm>
#include <cstddef>

#include "backends/devices/device.h"

namespace mssim {

/// Work-items of a launch, a multiple of those of a group.
struct WorkItems {
  cl::NDRange global, local;
};

/// How the work-items of a launch share work that comes in chunks of `lanes` nodes or springs each. On a CPU,
/// where a work-item has several lanes, few work-items take many chunks in turn, and yet enough that one that
/// was held up leaves some of its share to the others. Where it has one lane, each takes one.
struct OpenclChunks {
  WorkItems items;
  std::size_t per_item = 0;  ///< chunks of a work-item

  OpenclChunks(std::size_t chunks, const OpenclDevice& device, int lanes) {
    constexpr std::size_t good_items_per_unit = 16, good_group = 64;
    const bool wide = lanes > 1;
    const std::size_t local = wide ? 1 : good_group;
    per_item = wide ? std::max<std::size_t>(1, chunks / (good_items_per_unit * device.compute_units)) : 1;
    items = {cl::NDRange(((chunks + per_item - 1) / per_item + local - 1) / local * local),
             cl::NDRange(local)};
  }
};

}  // namespace mssim
