#pragma once

#include <memory>

#include "backends/interface/window_backend.h"
#include "backends/process/backend_program.h"

namespace mssim {

/// Processes that a program runs in.
struct RankCount {
  int ranks = 1;
  int threads = 1;  ///< of each
};

/// Those of a program in ranks: as many as its name says, or --ranks, each of the threads given or of its
/// share of all; where nobody says how many, as many as threads, of one thread each.
RankCount ranks_of(const BackendProgram& program, const ExecutionOptions& options);

/// Processors that the program may use.
int processors_of(const BackendProgram& program, const ExecutionOptions& options);

/// Starts the program for a cloth or bodies and waits until it is prepared. `program` and `system` must
/// outlive the backend. A call of it takes about 15 us beside what the program does with it (measured with
/// tests/backends/process/ on two cores of an AMD EPYC, Zen 4). Throws Unavailable, Unsupported and, like
/// each call of the backend, BackendFailure where the program does what docs/own-backends.md does not allow.
std::unique_ptr<Backend> make_process_backend(const BackendProgram& program, const System& system,
                                              const Integrator& integrator, double dt_s,
                                              const ExecutionOptions& options);

/// The same for a cloth of which this process has an outline alone, and a program that has windows
/// (Unsupported where it has not). `window_nodes`: of every window that it will be asked for. The backend
/// moves the states of an integrator that is ahead.
std::unique_ptr<WindowBackend> make_process_window_backend(const BackendProgram& program,
                                                           const System& outline,
                                                           const Integrator& integrator, double dt_s,
                                                           const ExecutionOptions& options,
                                                           std::size_t window_nodes);

}  // namespace mssim
