#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "backends/backends.h"
#include "backends/interface/backend.h"
#include "integrators/integrator.h"
#include "model/system.h"

namespace mssim {

/// Growth of the total energy, as a fraction of the available energy at the start, below which a run is
/// stable. The bound is small because an unstable run need not blow up: large motions are not linear, and may
/// end at several times the energy. Near the limit of a symplectic method, the energy of a stable oscillation
/// varies, too; if such stiff modes have a large fraction of the energy and no damping, this counts as
/// growth.
inline constexpr double allowed_energy_growth = 0.01;

/// The largest total energy, J, that a stable run of `system` may have: that of its start, plus
/// allowed_energy_growth of its kinetic and elastic energy and of the energy that gravity can still add (down
/// to the floor, or along the free fall of `span_s`, whichever is less), but at least what roundings of a
/// scene at rest give (energy_in_motion). Springs, gravity, resting pins and the floor do not increase the
/// total of kinetic, elastic and gravitational energy; damping decreases it. So any larger increase is an
/// error of the integrator.
double energy_bound(const System& system, double span_s);

/// Takes `steps` steps from the system's start, and checks the state about thirty times: all numbers must be
/// finite and the total energy within the bound.
bool stays_below(Backend& backend, const System& system, int steps, double bound_j);

/// Makes a backend of one integrator with this step, at the system's start.
using StepMaker = std::function<std::unique_ptr<Backend>(double dt_s)>;

/// The longest step that is tried, s: a frame at the lowest rate of frame_rates.
inline constexpr double longest_useful_step_s = 1.0 / 30;

/// Settings of a search for the largest stable step.
struct StepSearch {
  double first_s = 0;                                  ///< first step to try
  double longest_s = 0;                                ///< longest step to try
  double shortest_s = 0;                               ///< shortest step to try
  double span_s = 0;                                   ///< simulated time of a run
  int least_steps = 50;                                ///< of a run, beyond the span if necessary
  std::function<bool()> stop = [] { return false; };   ///< ends the search between two runs
  std::function<bool()> hurry = [] { return false; };  ///< ends it once it has steps of both kinds
};

/// The steps between which the limit of stability lies.
struct StableStep {
  double stable_s = 0;    ///< the longest step that was stable; 0: none
  double unstable_s = 0;  ///< the shortest longer step that was unstable; 0: none
  int runs = 0;
  double span_s = 0;     ///< simulated time of a run, at least
  bool finished = true;  ///< else stop() or hurry() ended the search before step_resolution
};

/// Whether a run of the search with this step stays within energy_bound. `backend` has that step.
bool is_stable(Backend& backend, const System& system, double dt_s, const StepSearch& search);

/// Ratio of the two steps that ends the search.
inline constexpr double step_resolution = 1.02;

/// The largest step with which runs stay within energy_bound. The search starts at `first_s` and goes up or
/// down by a factor of 1.5 and increasing factors until one step is stable and a longer one is not; then it
/// bisects their ratio. Growth too slow to show in a run counts as stable.
StableStep largest_stable_step(const System& system, const StepMaker& make, const StepSearch& search);

/// An integrator's largest stable step by linear theory, s; infinite for implicit integrators (backward Euler
/// is A-stable) and 0 if some mode grows with every step.
struct StepTheory {
  double at_start_s = 0;    ///< with the spectrum at the scene's start
  double on_the_way_s = 0;  ///< with the spectrum of the strained state that a run reaches
  double bound_s = 0;       ///< with Gershgorin's bound instead of a spectrum, as in `mssim check`
  double shortest_s() const { return at_start_s < on_the_way_s ? at_start_s : on_the_way_s; }
};

/// Computed from the amplification of the integrator's stages (integrators/stability.h). `reached`: the
/// spectrum of the strained state.
StepTheory step_theory(const Integrator& integrator, const System& system, const Spectrum& start,
                       const Spectrum& reached);

/// A sentence without a full stop about why the measured step and theory differ; empty if they differ by at
/// most 10 %. `floor_is_why`: the floor is the reason why the measured step is shorter.
std::string why_they_differ(const Integrator& integrator, const StableStep& measured,
                            const StepTheory& theory, bool floor_is_why);

/// The reason why a method has no points, or no more.
enum class Lack {
  nothing,      ///< no more points are needed
  time,         ///< wall time
  stable_step,  ///< no step that was tried is stable
  unsupported,  ///< the backend does not run this method
  unavailable,  ///< the backend does not run here
  not_timed,    ///< the backend's times mean nothing here
  failed        ///< the backend fails
};

/// How the measurements of a method ended.
struct Ending {
  Lack lack = Lack::nothing;
  std::string why = {};  ///< in words; may be empty if nothing is lacking
  /// Wall time lost with a program that did not answer in time, s; 0: it answered. A late program gets no
  /// more requests, because each would lose as much time.
  double late_s = 0;

  /// The column `status`: `why`, after the word for what the backend lacks.
  std::string status() const;
};

/// Calls `work`, which uses a backend. Lacks nothing unless the backend cannot run or be timed here, cannot
/// run this, or its program fails.
Ending ending_of(const std::function<void()>& work);

/// A program that was late.
struct LateProgram {
  const BackendInfo* backend = nullptr;
  Ending ending = {};
};

/// Largest usable step over the largest stable one, which is accurate to 2 % and from other runs than those
/// over the horizon.
inline constexpr double usable_share = 0.95;

/// An integrator and its limit of stability.
struct StepLimit {
  const Integrator* integrator = nullptr;
  std::string backend;       ///< on which the limit was measured
  double first_seconds = 0;  ///< wall time to make that backend with the first step that was tried
  double step_seconds = 0;   ///< wall time of that step
  StableStep measured;
  StepTheory theory;
  bool floor_is_why = false;      ///< the shortest unstable step is stable without the floor
  std::string why;                ///< why the two differ, or empty
  Ending ending;                  ///< why no backend measured anything
  std::vector<LateProgram> late;  ///< programs that were late

  Lack lack() const {
    if (ending.lack != Lack::nothing) return ending.lack;
    if (measured.stable_s > 0) return Lack::nothing;
    return measured.finished ? Lack::stable_step : Lack::time;
  }
  /// The largest usable step, s; 0: none is known to be stable.
  double usable_s() const { return usable_share * measured.stable_s; }
};

/// A backend to be timed, like make_backend. Throws, too, if its times mean nothing here, for ending_of.
std::unique_ptr<Backend> make_timed_backend(const BackendInfo& info, const System& system,
                                            const Integrator& integrator, double dt_s,
                                            const ExecutionOptions& execution);

/// Measured time of steps.
struct StepTime {
  double seconds = 0;  ///< per step, in the fastest run: other programs can only add time
  int runs = 0;
};

/// Times runs of `steps` steps from the system's start, after an uncounted run of at most ten steps, until
/// there are five runs with at least `enough_s` in total, or ten times `enough_s` have passed; at least one
/// run. If the first run has all the steps and takes that long, it is the only one. Only step() is timed.
StepTime time_steps(Backend& backend, const System& system, int steps, double enough_s);

/// Approximate wall time of time_steps if a run takes `run_s`.
double seconds_of_runs(double run_s, double enough_s);

/// Wall time per step, from a few steps.
double seconds_of_step(Backend& backend, const System& system);

/// Settings of the search for the limits of steps.
struct LimitRequest {
  const System* system = nullptr;
  std::vector<const BackendInfo*> backends;
  ExecutionOptions execution;
  Spectrum at_start, on_the_way;
  double seconds = 0;  ///< approximate wall time per integrator; more only until a step is stable
  std::function<bool()> stop = [] { return false; };
};

/// Simulated time of a run that decides whether a step is stable, if there is time for it.
inline constexpr double stability_span_s = 0.2;

/// Measures the integrator's largest stable step on the first backend that runs it, and explains differences
/// from theory. `openmp` comes first, because it is almost always the fastest, and the limit depends on the
/// integrator, not on the backend. A backend on which not even the shortest step is stable, unlike in the
/// double-precision reference, counts as one that fails.
StepLimit find_step_limit(const Integrator& integrator, const LimitRequest& request);

}  // namespace mssim
