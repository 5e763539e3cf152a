#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "backends/interface/backend.h"
#include "integrators/integrator.h"

namespace mssim {

/// A program that is a backend: it speaks the protocol of docs/protocol.md.
struct BackendProgram {
  std::string name;                      ///< of its rows
  std::string description;               ///< one line for `mssim list backends`
  std::vector<std::string> command;      ///< as its user wrote it: the program, and its arguments
  std::filesystem::path program;         ///< the file that is run; empty where it is missing
  std::vector<std::string> environment;  ///< NAME=VALUE, added to this process's
  std::filesystem::path folder;          ///< the one it runs in
  std::string missing;                   ///< why it cannot be run; empty where it can be
  bool steps_cloths = true;
  bool steps_bodies = true;
  std::vector<std::string> integrators;  ///< those that it has; empty: all explicit ones
  double time_limit_s = 120;             ///< of every answer
  /// It runs in several processes (--ranks), and builds its parts of a cloth from the scene's file.
  bool in_ranks = false;
  int ranks = 0;  ///< processes that its name asks for, as mpi:4 does; 0: --ranks
  /// It knows the requests `restart` and `get ROW COLUMN ROWS COLUMNS` of docs/protocol.md; in ranks
  /// alone.
  bool has_windows = false;
};

/// Longest time limit, s.
inline constexpr double longest_time_limit_s = 86400;

/// An integrator in the lines of the protocol: its name, and for each stage "stage x v" and its assignments,
/// "assign OUT" and the terms of the sum, each a coefficient, a power of dt and a slot.
std::string method_text(const Integrator& integrator);

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
/// outlive the backend. `window_nodes`: of every window that it will be asked for, where `system` is an
/// outline of a cloth, and the program has windows; the backend moves the states of an integrator that is
/// ahead. A call of it takes about 15 us beside what the program does with it (measured with
/// tests/backends/process/ on two cores of an AMD EPYC, Zen 4). Throws Unavailable, Unsupported and, like
/// each call of the backend, BackendFailure where the program does what docs/protocol.md does not allow.
std::unique_ptr<WindowBackend> make_process_backend(const BackendProgram& program, const System& system,
                                                    const Integrator& integrator, double dt_s,
                                                    const ExecutionOptions& options,
                                                    std::optional<std::size_t> window_nodes = {});

}  // namespace mssim
