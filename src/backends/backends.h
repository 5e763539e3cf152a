#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "backends/interface/backend.h"
#include "backends/process/process_backend.h"
#include "garment/stepping/dressing_backend.h"

namespace mssim {

/// The role of a backend in comparisons and automatic choices.
enum class BackendRole : std::uint8_t {
  as_published,  ///< described in a paper, or a user's program: measured only on request
  contender,     ///< optimised: `mssim guide` tries it, too
  best_of_host,  ///< the contender without a device; one row
  baseline       ///< base of all ratios, and in double precision the reference; one row
};

/// A row of the TABLE of backends, or of users' backends (own_backend).
struct BackendInfo {
  std::string_view name;
  /// Column of Hong et al.'s tables (`configuration` in the published CSV); empty for garments' rows and
  /// programs.
  std::string_view paper_configuration = {};
  std::string_view description = {};  ///< one line for `mssim list backends`
  bool uses_device = false;           ///< needs an OpenCL device
  bool makes_threads = false;         ///< creates as many threads as requested
  /// For an explicit integrator. Null if a program takes its steps, or if it steps garments only.
  BackendMaker* make = nullptr;
  MemoryUse grid_memory = {};  ///< for a cloth
  MemoryUse mesh_memory = {};  ///< for bodies
  /// Approximate time of a step of a cloth or of bodies with an explicit integrator on two cores, relative to
  /// `serial`: for plans (results/table1, results/table3).
  double step_share = 1;
  BackendRole role = BackendRole::as_published;
  /// Makes a backend that dresses a garment; null if it does not implement Algorithm 1.
  std::unique_ptr<DressingBackend> (*make_dressing)(const System& system, const Integrator& integrator,
                                                    double dt_s, const ExecutionOptions& options) = nullptr;
  BackendMaker* make_implicit = nullptr;  ///< for an implicit integrator; null if it has none
  /// Memory of that backend, for a cloth (`grid`) or bodies; null if `make_implicit` is.
  MemoryUse (*implicit_memory)(const Integrator& integrator, bool grid) = nullptr;
  /// Whether its steps are vector code, for which ExecutionOptions::instruction_set can be chosen.
  bool has_vectors = false;
  BackendMaker* make_in_double = nullptr;  ///< `make` in double precision; null if it has none
  bool collides_layers = false;            ///< `make_dressing` also dresses garments whose layers touch
  /// The program that takes its steps. It must outlive the row.
  const BackendProgram* program = nullptr;
  int threads = 0;  ///< fixed by the row; 0: the number requested
  /// Instruction set that the row fixes, by Highway's name; empty: the requested one.
  std::string_view instruction_set = {};
  bool in_double = false;  ///< steps in double precision (make_in_double), with explicit integrators only
  bool each_body = false;  ///< one backend per body of the scene; the bodies take a step in turn
  /// The double-precision counterpart of `make_dressing`, against which its garments are verified.
  std::unique_ptr<DressingBackend> (*make_dressing_reference)(const System& system,
                                                              const Integrator& integrator,
                                                              double dt_s) = make_reference_dressing;
};

/// The options for its steps: `asked`, except for those that the row fixes.
inline ExecutionOptions execution_of(const BackendInfo& backend, ExecutionOptions asked) {
  if (backend.threads > 0) asked.threads = backend.threads;
  if (!backend.instruction_set.empty()) asked.instruction_set = backend.instruction_set;
  return asked;
}

/// The row of a user's program. `program` must outlive it.
BackendInfo own_backend(const BackendProgram& program);

/// The TABLE of backends, in the order of all listings and results. A new backend is one row in backends.cpp.
std::span<const BackendInfo> backends();

/// The rows of the TABLE of published dressings (garment/stepping/published_dressing.h), in its order. They
/// step only garments, and have the role `as_published`.
std::span<const BackendInfo> garment_backends();

/// The names of the backends that have a feature, in words, as listed() joins them.
std::string names_of(bool (*has)(const BackendInfo& row), std::string_view last = "and");

/// The instruction sets of vector code (has_vectors) that this CPU supports, by Highway's names, the best
/// first.
std::vector<std::string_view> instruction_sets();

/// The row of that role.
const BackendInfo& baseline_backend();
const BackendInfo& best_host_backend();

/// The backend of that name, of both tables, or nullptr.
const BackendInfo* find_backend(std::string_view name);

/// Memory of the backend for a scene with this integrator: a cloth (`grid`) or bodies.
MemoryUse memory_of(const BackendInfo& backend, const Integrator& integrator, bool grid);

/// Empty if the backend can run here, else the reason why not.
std::string unavailable_reason(const BackendInfo& backend, const ExecutionOptions& options);

/// Why the row steps neither cloths nor bodies with this integrator; empty if it may.
std::string unsupported_reason(const BackendInfo& backend, const Integrator& integrator);

/// Why the row does not dress this garment; empty if it may.
std::string unsupported_reason(const BackendInfo& backend, const Garment& garment);

/// Makes the backend for any system. `system` must outlive it. Throws Unavailable, Unsupported or
/// BackendFailure.
std::unique_ptr<Backend> make_backend(const BackendInfo& backend, const System& system,
                                      const Integrator& integrator, double dt_s,
                                      const ExecutionOptions& asked);

/// Makes a backend for a system of one body. The system must outlive the backend.
using MakeBackend = std::function<std::unique_ptr<Backend>(const System& system)>;

/// One backend per body of a system, made by `make`. In each step they take one step each, in turn, as Hong
/// et al. step objects. Throws Unsupported for a cloth or a garment, and what `make` throws.
std::unique_ptr<Backend> make_for_each_body(const System& system, const MakeBackend& make);

/// Makes the program of `backend` for a cloth that is only outlined (outline_of_cloth). Its states are those
/// of the nodes of `windows` (make_process_backend). Throws Unavailable, Unsupported or BackendFailure.
std::unique_ptr<Backend> make_window_backend(const BackendInfo& backend, const System& outline,
                                             const Integrator& integrator, double dt_s,
                                             const ExecutionOptions& options,
                                             const std::vector<GridWindow>& windows);

/// Whether it supports windows of a cloth that no single process has as a whole.
inline bool has_windows(const BackendInfo& backend) {
  return backend.program != nullptr && backend.program->has_windows;
}

/// Makes the backend for a garment. Throws Unavailable, or Unsupported if it cannot dress.
std::unique_ptr<DressingBackend> make_dressing_backend(const BackendInfo& backend, const System& system,
                                                       const Integrator& integrator, double dt_s,
                                                       const ExecutionOptions& asked);

/// Whether the backend implements Algorithm 1 (garment/stepping/); others refuse garments.
inline bool dresses(const BackendInfo& backend) { return backend.make_dressing != nullptr; }

/// Whether it steps cloths; others refuse them.
inline bool steps_cloths(const BackendInfo& backend) {
  return backend.program != nullptr ? backend.program->steps_cloths
                                    : backend.make != nullptr && !backend.each_body;
}

/// Whether it steps bodies; others refuse them.
inline bool steps_bodies(const BackendInfo& backend) {
  return backend.program != nullptr ? backend.program->steps_bodies : backend.make != nullptr;
}

/// A note for readers of its times if a backend uses more CPUs than it was made for; else empty.
std::string excess_of(const BackendInfo& info, const Backend& backend, const ExecutionOptions& options);

/// The integrator in double precision on one thread, at the system's start: the reference for verifying every
/// timed row. Solvers of implicit integrators iterate until they improve no more; a long step ends when
/// `stop` returns true, and the state is then useless. `system` must outlive it. Throws Unsupported for a
/// garment.
std::unique_ptr<Backend> make_reference(const System& system, const Integrator& integrator, double dt_s,
                                        const std::function<bool()>& stop = {});

/// Memory of the reference for a cloth (`grid`) or bodies.
MemoryUse reference_memory(const Integrator& integrator, bool grid);

/// Runs mssim as another process for try_driver (devices/drivers.h) with these arguments: makes the backend
/// for a small system, and ends with exit code 0 even if that throws: the requesting process then throws the
/// same.
[[noreturn]] void run_driver_trial(std::span<char*> arguments);

}  // namespace mssim
