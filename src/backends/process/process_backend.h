#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "backends/interface/backend.h"
#include "integrators/integrator.h"

namespace mssim {

/// A program that is a backend: it uses the protocol of docs/protocol.md.
struct BackendProgram {
  std::string name;                      ///< name of its rows
  std::string description;               ///< one line for `mssim list backends`
  std::vector<std::string> command;      ///< as written by its user: the program and its arguments
  std::filesystem::path program;         ///< the file to run; empty if it is missing
  std::vector<std::string> environment;  ///< NAME=VALUE, added to this process's
  std::filesystem::path folder;          ///< working directory
  std::string missing;                   ///< why it cannot be run; empty if it can be
  bool steps_cloths = true;
  bool steps_bodies = true;
  std::vector<std::string> integrators;  ///< supported ones; empty: all explicit ones
  double time_limit_s = 120;             ///< for every answer
  /// It runs in several processes (--ranks), and builds its parts of a cloth from the scene file.
  bool in_ranks = false;
  int ranks = 0;  ///< processes set by its name, as in mpi:4; 0: --ranks
  /// It supports the requests `restart` and `get ROW COLUMN ROWS COLUMNS` of docs/protocol.md; only with
  /// ranks.
  bool has_windows = false;
};

/// Why the program does not step with this integrator; empty if it does.
std::string unsupported_reason(const BackendProgram& program, const Integrator& integrator);

/// Longest time limit, s.
inline constexpr double longest_time_limit_s = 86400;

/// The lines of the protocol for an integrator: its name, and for each stage "stage x v" and its assignments,
/// "assign OUT" and the terms of the sum, each a coefficient, a power of dt and a slot.
std::string method_text(const Integrator& integrator);

/// Number of processes of a program.
struct RankCount {
  int ranks = 1;
  int threads = 1;  ///< per process
};

/// The processes of a program with ranks: the number in its name, or --ranks, each with the given threads or
/// its share of the total; without a number, as many as threads, with one thread each.
RankCount ranks_of(const BackendProgram& program, const ExecutionOptions& options);

/// CPUs that the program may use.
int processors_of(const BackendProgram& program, const ExecutionOptions& options);

/// Starts the program for a cloth or bodies and waits until it is prepared. `program` and `system` must
/// outlive the backend. `windows`: of equal size, if `system` is an outline of a cloth and the program has
/// windows. States are then those of their nodes, window by window and row by row, and set_state returns to
/// the scene's start, whatever it is given. The backend moves the states of an integrator that is ahead
/// (step_ahead). A call takes about 15 us in addition to the program's work (measured with
/// tests/backends/process/ on two cores of an AMD EPYC, Zen 4). Throws Unavailable, Unsupported and, like
/// each call of the backend, BackendFailure if the program violates docs/protocol.md.
std::unique_ptr<Backend> make_process_backend(const BackendProgram& program, const System& system,
                                              const Integrator& integrator, double dt_s,
                                              const ExecutionOptions& options,
                                              const std::vector<GridWindow>& windows = {});

}  // namespace mssim
