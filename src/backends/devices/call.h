#pragma once

#include <CL/opencl.hpp>
#include <utility>

#include "backends/devices/device.h"

namespace mssim {

/// Does `work`; an OpenCL call in it that fails throws Failure with one sentence.
template <class Failure, class Work>
auto opencl_call(Work&& work) {
  try {
    return std::forward<Work>(work)();
  } catch (const cl::Error& error) {
    throw Failure(opencl_failure(error.what(), error.err()));
  }
}

}  // namespace mssim
