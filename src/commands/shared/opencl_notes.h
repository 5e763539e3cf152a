#pragma once

namespace mssim {

/// Says on stderr, once in a process, what the drivers of OpenCL devices lack. For a command that uses such a
/// device: it asks the drivers (backends/devices/offer.h).
void tell_of_opencl();

}  // namespace mssim
