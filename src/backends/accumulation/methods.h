#pragma once

#include <memory>

#include "backends/interface/backend.h"

namespace mssim {

/// Methods to let threads add spring forces to the nodes that springs share. These step the plain spring list
/// with options.threads threads (list_method.h) and differ in the accumulation alone; accumulation_methods.h
/// has the table.

/// A lock a node, taken for each end of each spring.
std::unique_ptr<Backend> make_lock_per_node(const System& system, const Integrator& integrator, double dt_s,
                                            const ExecutionOptions& options);

/// Atomic additions, three for each end of each spring.
std::unique_ptr<Backend> make_atomic(const System& system, const Integrator& integrator, double dt_s,
                                     const ExecutionOptions& options);

/// An array of forces for every thread, summed in the order of the threads.
std::unique_ptr<Backend> make_thread_private(const System& system, const Integrator& integrator, double dt_s,
                                             const ExecutionOptions& options);

/// Springs in colours that share no node, one colour after the other (spring_colouring.h).
std::unique_ptr<Backend> make_colouring(const System& system, const Integrator& integrator, double dt_s,
                                        const ExecutionOptions& options);

/// Every node sums the forces of its own springs, so that each spring is computed from both ends.
std::unique_ptr<Backend> make_gather(const System& system, const Integrator& integrator, double dt_s,
                                     const ExecutionOptions& options);

}  // namespace mssim
