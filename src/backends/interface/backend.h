#pragma once

#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include "integrators/integrator.h"
#include "kernels/parameters.h"
#include "model/system.h"
#include "text/error.h"

namespace mssim {

/// Surroundings (kernels/parameters.h) in double precision.
struct SurroundingsInDouble {
  double viscous_damping, gravity, floor_height, restitution, friction;
};
/// The surroundings of a system for steps in numbers of type `Real`: float or double.
template <class Real>
using SurroundingsOf = std::conditional_t<std::is_same_v<Real, float>, Surroundings, SurroundingsInDouble>;
template <class Real = float>
SurroundingsOf<Real> surroundings_of(const System& system) {
  return {static_cast<Real>(system.viscous_damping), static_cast<Real>(system.gravity),
          static_cast<Real>(system.floor.height), static_cast<Real>(system.floor.restitution),
          static_cast<Real>(system.floor.friction)};
}

/// Costs of communication between processes that step together; none of those that they do not tell.
struct Communication {
  std::optional<double> waiting;  ///< fraction of the step time that a process waits for others; mean of all
  /// Fraction of the step time for packing, copying if the CPU does it, and unpacking.
  std::optional<double> packing;
  std::optional<double> bytes;     ///< sent per step by the process that sends most
  std::optional<double> messages;  ///< sent per step by that process
  /// Half of the round-trip time of a message of a few bytes to a neighbour, s, over the slowest link;
  /// nothing if there is no neighbour.
  std::optional<double> latency_s;
  std::optional<double> bytes_per_second;  ///< of large messages to a neighbour, over the slowest link

  friend bool operator==(const Communication& a, const Communication& b) = default;
};

/// How host and OpenCL device exchange data.
enum class DeviceMemory : std::uint8_t {
  /// Both work on the same arrays in turn. Nothing is copied if the device shares the host's memory;
  /// otherwise the driver copies an array when it changes hands.
  shared,
  /// Each has arrays of its own, and changes are copied explicitly.
  copy
};

/// How `openmp` and `gather-vectors` compute the reciprocal length of a spring.
enum class Roots : std::uint8_t {
  fast,  ///< the fastest method of the CPU's instruction set
  exact  ///< a root and a division, each correctly rounded: bitwise identical on all CPUs with FMA
};

/// The user's choices of where and how a backend runs.
struct ExecutionOptions {
  int threads = 0;  ///< host threads, and compute units of a device that is a CPU; at least 1
  std::string device =
      {};  ///< OpenCL device: its number in `mssim list devices` or a part of its name; empty: first
  DeviceMemory memory = DeviceMemory::shared;  ///< for backends that use a device
  Roots roots = Roots::fast;
  std::string instruction_set = {};       ///< of vector code, by Highway's name; empty: the best
  std::string scene = {};                 ///< the scene's name, for users' programs
  std::filesystem::path scene_file = {};  ///< the scene's file, for users' programs
  int ranks = 0;                          ///< processes of a program with ranks; 0: as many as threads
  bool threads_given = false;             ///< `threads` is per rank, else the total
  std::string launcher = {};              ///< command that starts the ranks; empty: the program's default
};

/// Thrown if a backend cannot run here (no device, no driver); what() is the reason, for the row and `list`.
struct Unavailable : ErrorWith<exit_unavailable> {
  using ErrorWith::ErrorWith;
};

/// Thrown if a backend runs here but not with this scene or integrator; what() is the reason.
struct Unsupported : ErrorWith<exit_bad_input> {
  using ErrorWith::ErrorWith;
};

/// Thrown by any call of a backend whose program has failed; what() is the reason, for the row.
struct BackendFailure : Error {
  BackendFailure(const std::string& reason, std::string last_output, bool is_late = false)
      : Error(exit_not_verified, reason), output(std::move(last_output)), late(is_late) {}
  std::string output;  ///< the program's last output
  bool late;           ///< it did not answer in time; another request would take as long again
};

/// The mass of every node, kg. Throws Unsupported if they differ.
inline double require_uniform_mass(const System& system) {
  const std::optional<double> mass = uniform_node_mass(system);
  if (!mass) throw Unsupported("the nodes of a cloth must have the same mass, and those of this one do not");
  return *mass;
}

/// Whether the system is stepped with Algorithm 1 (garment/stepping/).
inline bool is_garment(const System& system) { return std::holds_alternative<Garment>(system.topology); }

/// A running simulation. All calls block until their work is done, so a caller may read the clock around
/// them.
class Backend {
 public:
  Backend() = default;
  Backend(const Backend&) = delete;
  Backend& operator=(const Backend&) = delete;
  virtual ~Backend() = default;

  /// Sets a state of the system's size; pinned nodes must be at their start, at rest.
  virtual void set_state(const State& state) = 0;
  /// Takes `count` steps of the dt given at construction. Does not check for finite numbers: callers do,
  /// outside timed regions.
  virtual void step(int count) = 0;
  /// The current state, in the scene's node order.
  virtual State state() const = 0;
  /// Where the steps run, for the `device` column: for example an OpenCL device's name.
  virtual std::string device() const { return "cpu"; }
  /// Threads of this machine that compute a step; for a discrete device, 1 (the host thread that waits). More
  /// than ExecutionOptions::threads only if a driver cannot be limited.
  virtual int threads() const = 0;
  /// Whole steps per pass over the state in memory, if stages overlap; 0 if every stage makes its own pass.
  /// The memory traffic of a step is derived from it.
  virtual int steps_per_pass() const { return 0; }
  /// Springs whose ends and rest lengths a step reads from memory, if fewer than the system's: identical
  /// bodies can share theirs.
  virtual std::optional<std::uint64_t> stored_springs() const { return std::nullopt; }
  /// Do the steps run on this machine's CPU and memory, with whose peaks the roofline compares?
  virtual bool runs_on_host() const { return true; }
  /// Caveats for readers of its times, for example iteration limits that its steps have reached; or empty.
  virtual std::string note() const { return {}; }

  // Only users' programs answer these otherwise: a backend that steps with another of mssim's own need not
  // pass them on.

  /// Does it compute in single precision? The roofline counts numbers of four bytes. False only of a program
  /// that says so: the row of mssim's own backends knows (BackendInfo::in_double).
  virtual bool is_in_single() const { return true; }
  /// Why its times are meaningless on this machine although its steps are right; or empty.
  virtual std::string reason_not_to_time() const { return {}; }
  /// Why it uses more CPUs than requested, if it does.
  virtual std::string reason_for_excess() const { return "the driver of " + device() + " cannot divide it"; }
  /// Costs of communication since the last call; nothing if there is only one process or a program does not
  /// report them.
  virtual std::optional<Communication> communication() { return std::nullopt; }
  /// Called before an idle period. The backend must not consume CPU time until its next call.
  virtual void rest() {}
  /// Ends the backend's program, if it has one, and returns its last output. Only end() may be called
  /// afterwards.
  virtual std::string end() { return {}; }
  /// CPU time so far of the process that takes the steps, s.
  virtual double processor_seconds() const {
    timespec time{};
    ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }
  /// Do threads of this process take the steps? Not those of a program that mssim has started.
  virtual bool steps_in_process() const { return true; }
  /// Sum of the largest resident memory that each living process of its program has had, bytes; none if it
  /// has no program, or if the system does not tell.
  virtual std::optional<std::uint64_t> program_peak_bytes() const { return std::nullopt; }
};

/// Makes a backend for a cloth or bodies, at the system's start state. `system` must outlive it. Throws
/// Unavailable or Unsupported.
using BackendMaker = std::unique_ptr<Backend>(const System& system, const Integrator& integrator, double dt_s,
                                              const ExecutionOptions& options);

/// Peak memory of a backend, usually reached during construction: bytes per node, per node and pair that the
/// integrator needs, per node and thread, per node and doubling of the number of nodes, and per spring.
/// Memory that does not grow with the scene is omitted.
struct MemoryUse {
  double node = 0;
  double pair_node = 0;
  Storage storage = Storage::in_place;  ///< determines the pairs that it needs
  double thread_node = 0;
  double doubling_node = 0;   ///< sparse factors of a cloth, which fill as they grow
  double cube_root_node = 0;  ///< sparse factors of bodies, which fill faster
  double spring = 0;

  double bytes(const Integrator& integrator, std::uint64_t nodes, std::uint64_t springs, int threads) const {
    const auto pairs = static_cast<double>(stored_pairs(integrator, storage).size());
    const double doublings = std::log2(std::max(1.0, static_cast<double>(nodes)));
    const double cube_root = std::cbrt(static_cast<double>(nodes));
    return (node + pair_node * pairs + thread_node * threads + doubling_node * doublings +
            cube_root_node * cube_root) *
               static_cast<double>(nodes) +
           spring * static_cast<double>(springs);
  }
};

/// Memory use of SpringList<float>.
inline constexpr MemoryUse spring_list_memory{.node = 17, .pair_node = 24};

/// The state with its positions moved along the velocities, to those that an integrator `seconds` ahead uses.
State moved_ahead(State state, double seconds);

/// Moves positions back along the velocities, from those that such an integrator uses to those of the state.
/// A node that this would move below the floor (its height in m), because it has just touched it, is put on
/// the floor.
void move_back(State& state, double seconds, double floor);

/// Adapts `backend`, whose stages see positions integrator.ahead of a step ahead of the state's: moves states
/// along their velocities on the way in, and back on the way out. `system` must outlive it. An integrator
/// that is not ahead leaves the backend unchanged. (A backend that is a user's program does this itself.)
std::unique_ptr<Backend> step_ahead(std::unique_ptr<Backend> backend, const System& system,
                                    const Integrator& integrator, double dt_s);

}  // namespace mssim
