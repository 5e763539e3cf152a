#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "backends/interface/backend.h"
#include "backends/process/process_backend.h"
#include "garment/stepping/dressing_backend.h"
#include "platform/machine.h"

namespace mssim {

/// What a backend is to those who compare backends, or need one that is good for all.
enum class BackendRole : std::uint8_t {
  as_published,  ///< what a paper describes, or a program of the user's: measured where it is asked for
  contender,     ///< written to be fast: a guide tries it, too
  best_of_host,  ///< the contender that needs no device; one row
  baseline       ///< what all are compared with, and in double precision the reference; one row
};

/// A row of the TABLE of backends, or of those that a user brings (own_backend).
struct BackendInfo {
  std::string_view name;
  std::string_view
      paper_configuration;       ///< column of Hong et al.'s tables (`configuration` in the published CSV)
  std::string_view description;  ///< one line for `mssim list backends`
  bool uses_device;              ///< needs an OpenCL device
  /// The stack of the threads that it makes, where it makes as many as it is asked for.
  std::optional<ThreadStack> makes_threads;
  /// Makes a backend for a cloth or bodies and an explicit integrator, at the system's start state. `system`
  /// must outlive it. Throws Unavailable or Unsupported.
  std::unique_ptr<Backend> (*make)(const System& system, const Integrator& integrator, double dt_s,
                                   const ExecutionOptions& options);
  MemoryUse grid_memory;  ///< for a cloth
  MemoryUse mesh_memory;  ///< for bodies
  /// A step of a cloth or of bodies with an explicit integrator, in steps of `serial`, about, on two
  /// processors: for plans (results/table1, results/table3).
  double step_share = 1;
  BackendRole role = BackendRole::as_published;
  /// Makes one that dresses a garment; null where it has not Algorithm 1.
  std::unique_ptr<DressingBackend> (*make_dressing)(const System& system, const Integrator& integrator,
                                                    double dt_s, const ExecutionOptions& options) = nullptr;
  /// Makes one for an implicit integrator, of a cloth or bodies; null where it has none.
  std::unique_ptr<Backend> (*make_implicit)(const System& system, const Integrator& integrator, double dt_s,
                                            const ExecutionOptions& options) = nullptr;
  /// What that takes, for a cloth or for bodies; null where `make_implicit` is.
  MemoryUse (*implicit_memory)(const Integrator& integrator, bool grid) = nullptr;
  /// The program that takes its steps; `make` is null then. It outlives the row.
  const BackendProgram* program = nullptr;
  int threads = 0;  ///< of a row that says them itself; 0: as many as asked for
  bool each_body = false;  ///< one backend per body of the scene; the bodies take a step in turn
  /// What `make_dressing` makes, in double precision: its garments are verified against it.
  std::unique_ptr<DressingBackend> (*make_dressing_reference)(const System& system,
                                                              const Integrator& integrator,
                                                              double dt_s) = make_reference_dressing;
};

/// What its steps run with: `asked`, but for what the row says itself.
inline ExecutionOptions execution_of(const BackendInfo& backend, ExecutionOptions asked) {
  if (backend.threads > 0) asked.threads = backend.threads;
  return asked;
}

/// The row of a program that is a backend. `program` must outlive it.
BackendInfo own_backend(const BackendProgram& program);

/// The TABLE of backends, in the order of every listing and result. A new backend is one row in backends.cpp.
std::span<const BackendInfo> backends();

/// The rows of the TABLE of published dressings (garment/stepping/published_dressing.h), in its order: they
/// step nothing but garments, and have the role `as_published`.
std::span<const BackendInfo> garment_backends();

/// The one row of that role.
const BackendInfo& baseline_backend();
const BackendInfo& best_host_backend();

/// The backend of that name, of both tables, or nullptr.
const BackendInfo* find_backend(std::string_view name);

/// What the backend takes for a scene with this integrator: a cloth (`grid`) or bodies.
MemoryUse memory_of(const BackendInfo& backend, const Integrator& integrator, bool grid);

/// Empty when the backend can run here, else the reason why not.
std::string unavailable_reason(const BackendInfo& backend, const ExecutionOptions& options);

/// Makes the backend for any system. Throws Unavailable, Unsupported or BackendFailure; Unsupported also
/// where it is to step each body for itself, and the system has no bodies.
std::unique_ptr<Backend> make_backend(const BackendInfo& backend, const System& system,
                                      const Integrator& integrator, double dt_s,
                                      const ExecutionOptions& options);

/// What makes a backend for a system of one body, which must outlive it.
using MakeBackend = std::function<std::unique_ptr<Backend>(const System& system)>;

/// A backend for each body of a system, made by `make`. In each step they take theirs one after the other, as
/// Hong et al. step objects. Throws Unsupported for a cloth or a garment, and what `make` throws.
std::unique_ptr<Backend> make_for_each_body(const System& system, const MakeBackend& make);

/// Makes the program of `backend` for a cloth of which there is an outline alone (outline_of_cloth).
/// `window_nodes`: of every window that it will be asked for. Throws Unavailable, Unsupported or
/// BackendFailure.
std::unique_ptr<WindowBackend> make_window_backend(const BackendInfo& backend, const System& outline,
                                                   const Integrator& integrator, double dt_s,
                                                   const ExecutionOptions& options, std::size_t window_nodes);

/// Whether it can be asked for windows of a cloth that no process has the whole of.
inline bool has_windows(const BackendInfo& backend) {
  return backend.program != nullptr && backend.program->has_windows;
}

/// Makes it for a garment. Throws Unavailable or Unsupported, the latter also where it cannot dress.
std::unique_ptr<DressingBackend> make_dressing_backend(const BackendInfo& backend, const System& system,
                                                       const Integrator& integrator, double dt_s,
                                                       const ExecutionOptions& options);

/// Whether the backend has Algorithm 1 (garment/stepping/); one that has not refuses garments.
inline bool dresses(const BackendInfo& backend) { return backend.make_dressing != nullptr; }

/// What a reader of its times must know of a backend that takes more processors than those that it was made
/// for; empty for all others.
std::string excess_of(const BackendInfo& info, const Backend& backend, const ExecutionOptions& options);

/// The integrator in double precision on one thread, at the system's start: the reference that every timed
/// row is verified against. Solvers of implicit integrators go on until they gain nothing more; where a step
/// of them may take long, it ends when `stop` says so, and the state is then of no use. `system` must outlive
/// it. Throws Unsupported for a garment.
std::unique_ptr<Backend> make_reference(const System& system, const Integrator& integrator, double dt_s,
                                        const std::function<bool()>& stop = {});

/// What the reference takes for a cloth (`grid`) or bodies.
MemoryUse reference_memory(const Integrator& integrator, bool grid);

/// What mssim does as another process for try_driver (devices/drivers.h), whose arguments these are:
/// makes the backend for a small system, and ends with exit code 0, whatever it throws: the process that
/// asked for it then throws the same.
[[noreturn]] void run_driver_trial(std::span<char*> arguments);

}  // namespace mssim
