#pragma once

#include "backends/devices/device.h"

namespace mssim {

/// A part of the device that has `count` compute units, where it is this machine's processor and has more:
/// the driver then runs kernels on so many processors and leaves the others alone. The device itself where it
/// is no processor, has no more, or its driver cannot divide it; compute_units of what is returned is the
/// truth. The same part whenever it is asked for.
OpenclDevice part_of(const OpenclDevice& device, int count);

/// Processors of this machine that run a device's kernels, or one thread that waits for it.
int threads_of(const OpenclDevice& device);

}  // namespace mssim
