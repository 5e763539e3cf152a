#pragma once

#include "backends/interface/backend.h"

namespace mssim {

/// The paper's "CPU only": one thread, an array of nodes, a loop over the spring list that adds to both ends.
/// The baseline: compiled like all timed code, neither tuned nor slowed down.
BackendMaker make_serial;

/// make_serial in double precision.
BackendMaker make_serial_in_double;

/// The paper's "Multi-thread CPU" as published (Hong et al., Figure 5): springs and nodes are split into one
/// group per thread; each thread computes its springs' forces and adds them to the nodes inside a critical
/// section.
BackendMaker make_threads_mutex;

}  // namespace mssim
