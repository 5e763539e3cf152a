#pragma once

#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "integrators/integrator.h"
#include "kernels/parameters.h"
#include "model/system.h"
#include "text/error.h"

namespace mssim {

/// The surroundings of a system, as the backends in single precision compute with them.
inline Surroundings surroundings_of(const System& system) {
  return {static_cast<float>(system.viscous_damping), static_cast<float>(system.gravity),
          static_cast<float>(system.floor.height), static_cast<float>(system.floor.restitution),
          static_cast<float>(system.floor.friction)};
}

/// What processes that take steps together spend on each other.
struct Communication {
  double waiting = 0;  ///< share of the time of a step that a process waits for others; mean of all
  /// Share of the time for packing what is sent, copying it where the processor does that, and unpacking what
  /// has come.
  double packing = 0;
  double bytes = 0;     ///< that the process with most sends in a step
  double messages = 0;  ///< the same
  /// Half of the time that a message of a few bytes takes to a neighbour and back, s, where it takes longest;
  /// none where there is no neighbour.
  std::optional<double> latency_s;
  std::optional<double> bytes_per_second;  ///< of large messages to a neighbour, where they are slowest

  friend bool operator==(const Communication& a, const Communication& b) = default;
};

/// How host and OpenCL device exchange data.
enum class DeviceMemory : std::uint8_t {
  /// Both work on the same arrays in turn. Where the device shares the host's memory nothing is copied;
  /// elsewhere the driver copies an array each time it changes hands.
  shared,
  /// Each has arrays of its own, and what changed is copied from one to the other.
  copy
};

/// How `openmp` and `gather-vectors` find the reciprocal length of a spring.
enum class Roots : std::uint8_t {
  fast,  ///< as is fastest with the processor's instruction set
  exact  ///< by a root and a division, each correctly rounded: the same bits on every processor that has FMA
};

/// What the user chose about where and how a backend runs.
struct ExecutionOptions {
  int threads = 0;  ///< host threads, and compute units of a device that is a processor; at least 1
  std::string device =
      {};  ///< OpenCL device: its number in `mssim list devices` or a part of its name; empty: first
  DeviceMemory memory = DeviceMemory::shared;  ///< of the backends that use a device
  Roots roots = Roots::fast;
  std::string scene = {};                 ///< its name, which a program that is a backend is told
  std::filesystem::path scene_file = {};  ///< the file that it comes from, the same
  int ranks = 0;               ///< processes of a program that runs in several; 0: as many as threads
  bool threads_given = false;  ///< `threads` are those of each rank, and else of all together
  std::string launcher = {};   ///< command that starts them; empty: the program's usual one
};

/// Thrown when a backend cannot run here (no device, no driver); what() is the reason for the row and `list`.
struct Unavailable : ErrorWith<exit_unavailable> {
  using ErrorWith::ErrorWith;
};

/// Thrown when a backend runs here but not this scene or integrator; what() is the reason.
struct Unsupported : ErrorWith<exit_bad_input> {
  using ErrorWith::ErrorWith;
};

/// Thrown by any call of a backend behind which a program stands that failed; what() is the reason for the
/// row.
struct BackendFailure : Error {
  BackendFailure(const std::string& reason, std::string last_output, bool is_late = false)
      : Error(exit_not_verified, reason), output(std::move(last_output)), late(is_late) {}
  std::string output;  ///< what the program wrote last
  bool late;           ///< it has not answered in time: asked again, it would take as long again
};

/// The mass of every node, kg. Throws Unsupported when they differ.
inline double require_uniform_mass(const System& system) {
  const std::optional<double> mass = uniform_node_mass(system);
  if (!mass) throw Unsupported("the nodes of a cloth must have the same mass, and those of this one do not");
  return *mass;
}

/// Whether the system's steps are those of Algorithm 1 (garment/stepping/).
inline bool is_garment(const System& system) { return std::holds_alternative<Garment>(system.topology); }

/// One simulation under way. All calls block until their work is done: a caller may read the clock around
/// them.
class Backend {
 public:
  Backend() = default;
  Backend(const Backend&) = delete;
  Backend& operator=(const Backend&) = delete;
  virtual ~Backend() = default;

  /// Takes a state of the system's size; pinned nodes must stand at their start, at rest.
  virtual void set_state(const State& state) = 0;
  /// Takes `count` steps of the dt given at construction. Never checks its numbers: callers do, outside timed
  /// regions.
  virtual void step(int count) = 0;
  /// The present state, in the scene's node order.
  virtual State state() const = 0;
  /// What the steps run on, for the `device` column, for example an OpenCL device's name.
  virtual std::string device() const { return "cpu"; }
  /// Processors of this machine that compute a step; of a device with processors of its own, the thread that
  /// waits for it. More than ExecutionOptions::threads only where a driver cannot keep to it.
  virtual int threads() const = 0;
  /// Whole steps that one pass over the state in memory takes, where stages overlap; 0 where every stage
  /// makes a pass of its own. What a step moves through memory is counted by it.
  virtual int steps_per_pass() const { return 0; }
  /// Springs whose ends and rest lengths a step reads from memory, where these are not all of the system's:
  /// bodies that are alike can share theirs.
  virtual std::optional<std::uint64_t> stored_springs() const { return std::nullopt; }
  /// Do the steps run on this machine's processor and memory, whose peaks the roofline compares with?
  virtual bool runs_on_host() const { return true; }
  /// What a reader of its times must know of it by now, or nothing: the limits that its steps have met, say.
  virtual std::string note() const { return {}; }
  /// Why its times would mean nothing on this machine, though its steps are right; or nothing.
  virtual std::string reason_not_to_time() const { return {}; }
  /// Why it takes more processors than it was asked to, where it does.
  virtual std::string reason_for_excess() const { return "the driver of " + device() + " cannot divide it"; }
  /// What the processes that take the steps have spent on each other since this was last asked; none where
  /// there is one process, or where a program does not tell.
  virtual std::optional<Communication> communication() { return std::nullopt; }
  /// Says that nothing will be asked of it for a while: it shall not disturb what is timed meanwhile.
  virtual void rest() {}
  /// Ends the program behind it, where there is one, and returns what that wrote last. Nothing but another
  /// end() may be asked of it then.
  virtual std::string end() { return {}; }
  /// Processor time so far of the process that takes the steps, s.
  virtual double processor_seconds() const {
    timespec time{};
    ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }
};

/// Memory that a backend takes at its peak, which is mostly while it is made: bytes a node, a node and pair
/// that the integrator needs, a node and thread, a node and doubling of the number of nodes, and a spring.
/// What does not grow with the scene is left out.
struct MemoryUse {
  double node = 0;
  double pair_node = 0;
  Storage storage = Storage::in_place;  ///< which pairs it needs
  double thread_node = 0;
  double doubling_node = 0;   ///< of sparse factors of a cloth, which fill as they grow
  double cube_root_node = 0;  ///< of sparse factors of bodies, which fill faster
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

/// The memory of a SpringList<float>.
inline constexpr MemoryUse spring_list_memory{.node = 17, .pair_node = 24};

/// A backend for a cloth of which no single process has the whole: it builds the scene by itself, and gives
/// the states of some nodes at a time. Neither set_state nor state may be called of it.
class WindowBackend : public Backend {
 public:
  /// Goes back to the scene's start state.
  virtual void restart() = 0;
  /// The present state of the window's nodes, row by row.
  virtual State window(const GridWindow& window) const = 0;
};

/// Moves positions back along the velocities, from where an integrator that is so many seconds ahead sees
/// them to where the state has them. A node that this would take below the floor (its height in m), because
/// it has just met it, is put onto the floor.
void move_back(State& state, double seconds, double floor);

/// `backend`, whose stages see positions integrator.ahead of a step ahead of the state's: what goes in is
/// moved along its velocity, and what comes out back. `system` must outlive it. An integrator that is not
/// ahead leaves the backend as it is.
std::unique_ptr<Backend> step_ahead(std::unique_ptr<Backend> backend, const System& system,
                                    const Integrator& integrator, double dt_s);

}  // namespace mssim
