#pragma once

#include <cstddef>

#include "bench/roofline/step_cost.h"

namespace mssim {

/// What this machine does at best with a number of threads: the roofs of the roofline.
struct MachinePeak {
  double bytes_per_second = 0;  ///< triad a = b + s c, 12 bytes an element (two loads, one store)
  double flops_per_second = 0;  ///< fused multiply-adds in single precision, two operations each
};

/// Measures both in this process, now, with `threads` OpenMP threads (at least 1), in about a quarter of a
/// second: the fastest of many repetitions, because a peak is what the machine can do undisturbed.
/// The triad's three arrays together are about `working_set_bytes` large (from 1.5 KiB a thread up to 256
/// MiB, where no cache helps any more), so that a step is held against the cache level that it works in. The
/// store is tried both through the caches and past them. Vector instructions are the widest that this
/// processor has. Throws std::bad_alloc.
MachinePeak measure_peak(int threads, std::size_t working_set_bytes);

/// The least time that the machine needs for the step over the time it took: 1 on the roof.
/// Source: S. Williams, A. Waterman, D. Patterson, Roofline: An Insightful Visual Performance Model for
/// Multicore Architectures, Communications of the ACM 52 (2009), 65-76.
double roofline_fraction(const StepCost& cost, double seconds, const MachinePeak& peak);

}  // namespace mssim
