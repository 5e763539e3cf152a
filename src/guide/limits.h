#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "backends/backends.h"
#include "backends/interface/backend.h"
#include "integrators/integrator.h"
#include "model/system.h"
#include "platform/machine.h"

namespace mssim {

/// What a step of one size costs and how far off it ends: a point of a work-precision curve (Hairer, Norsett
/// and Wanner, Solving Ordinary Differential Equations I, section II.10).
struct WorkPoint {
  const Integrator* integrator = nullptr;
  std::string backend;
  int steps = 0;              ///< over the horizon
  double dt_s = 0;            ///< of simulated time
  double seconds_a_step = 0;  ///< of wall time, in the fastest of `samples` runs over the horizon
  int samples = 0;
  /// Force evaluations a step: the stages of an explicit method, the iterations of fast-springs, the small
  /// steps of xpbd. None of methods with conjugate gradients, whose number differs from step to step.
  std::optional<double> evaluations;
  bool diverged = false;  ///< not finite, or with more energy than energy_bound allows
  /// The step is no longer than the largest that was stable in runs, which may be longer than the horizon:
  /// what does not diverge within that may do so when it meets the floor.
  bool within_limit = true;
  /// Largest distance from the trusted state at the horizon, in mean rest lengths; none where not finite.
  std::optional<double> position_error;
  std::optional<double> energy_error;  ///< of the total energy, over the trusted kinetic + elastic energy
  /// Errors of an implicit method, in mean rest lengths, where there was time to tell them apart: the
  /// solver's, which is the distance from exact backward Euler with the same step, and the step's, which is
  /// that one's distance from the trusted state.
  std::optional<double> solver_error, step_error;
  bool beyond_trust = false;  ///< the error is not trusted_margin times the trusted state's own
  bool on_front = false;      ///< no other point is both as fast and as accurate (mark_pareto_front)
  std::string note;           ///< the backend's

  /// Wall time of a simulated second, s: what a user waits for.
  double seconds_a_second() const { return seconds_a_step / dt_s; }
  /// Whether conclusions may rest on it.
  bool counts() const { return !diverged && within_limit && !beyond_trust && position_error.has_value(); }
};

/// Whether both are points of one method.
inline bool same_method(const WorkPoint& a, const WorkPoint& b) {
  return a.integrator == b.integrator && a.backend == b.backend;
}

/// Growth of the total energy, as a share of what there is at the start, that no run of a stable step shows.
/// Little, because what is unstable need not blow up: large motions are not linear, and may end at several
/// times the energy. Near the limit of a symplectic method a stable oscillation, too, takes its energy up and
/// down; where modes that stiff carry a large share of the energy and nothing damps them, that counts as
/// growth.
inline constexpr double allowed_energy_growth = 0.01;

/// The largest total energy, J, that a run of `system` may have: that of its start, and allowed_energy_growth
/// of its kinetic and elastic energy and of what gravity can still give (down to the floor, or along the
/// free fall of `span_s`, whichever is less). Springs, gravity, pins, which are at rest, and the floor add
/// nothing to the total of kinetic, elastic and gravitational energy; damping takes of it. So what comes in
/// is the integrator's.
double energy_bound(const System& system, double span_s);

/// Lets the backend take `steps` steps from the system's start, and looks at the state some thirty times on
/// the way: whether all numbers stay finite and the total energy below the bound.
bool stays_below(Backend& backend, const System& system, int steps, double bound_j);

/// A backend of one integrator with this step, at the system's start.
using StepMaker = std::function<std::unique_ptr<Backend>(double dt_s)>;

/// The longest step that is tried, s: a frame of the slowest rate that is asked about.
inline constexpr double longest_useful_step_s = 1.0 / 30;

/// Where the largest stable step is looked for, and by which runs.
struct StepSearch {
  double first_s = 0;                                  ///< step that is tried first
  double longest_s = 0;                                ///< no longer one is tried
  double shortest_s = 0;                               ///< no shorter one is tried
  double span_s = 0;                                   ///< simulated time of a run
  int least_steps = 50;                                ///< of a run: it goes on beyond the span for them
  std::function<bool()> stop = [] { return false; };   ///< ends the search between two runs
  std::function<bool()> hurry = [] { return false; };  ///< ends it as soon as it knows both kinds of step
};

/// Between which steps the limit lies.
struct StableStep {
  double stable_s = 0;    ///< the longest step that was stable; 0: none that was tried
  double unstable_s = 0;  ///< the shortest longer one that was not; 0: none that was tried
  int runs = 0;
  double span_s = 0;     ///< simulated time of a run, at least
  bool finished = true;  ///< else stop() or hurry() ended the search before the two were near each other
};

/// Whether a run of the search with this step stays below energy_bound. `backend` has that step.
bool is_stable(Backend& backend, const System& system, double dt_s, const StepSearch& search);

/// Two steps this near to each other (as a ratio) end the search.
inline constexpr double step_resolution = 1.02;

/// The largest step with which real runs stay below energy_bound: from `first_s` up or down by half as much
/// again, and by ever larger strides, until one step is stable and a longer one is not; then by bisection of
/// their ratio. What grows so slowly that a run does not show it counts as stable.
StableStep largest_stable_step(const System& system, const StepMaker& make, const StepSearch& search);

/// What linear theory says of an integrator's largest stable step, s; infinite for implicit integrators
/// (backward Euler is A-stable) and 0 where no step keeps every mode from growing.
struct StepTheory {
  double at_start_s = 0;    ///< with the spectrum at the scene's start
  double on_the_way_s = 0;  ///< with the spectrum of the strained state that a run reaches
  double bound_s = 0;       ///< with Gershgorin's bound in place of a spectrum, as `mssim check` has it
  double shortest_s() const { return at_start_s < on_the_way_s ? at_start_s : on_the_way_s; }
};

/// By the amplification that the integrator's stages have (integrators/stability.h). `reached`: the spectrum
/// of the strained state.
StepTheory step_theory(const Integrator& integrator, const System& system, const Spectrum& start,
                       const Spectrum& reached);

/// A sentence without a full stop that says why the measured step and theory differ; empty where they
/// are within 10 % of each other. `floor_is_why`: where the measured one is shorter, only the floor makes it
/// so.
std::string why_they_differ(const Integrator& integrator, const StableStep& measured,
                            const StepTheory& theory, bool floor_is_why);

/// Whether the two differ by so much that the page says why, and theory has the longer one.
bool is_shorter_than_theory(const StableStep& measured, const StepTheory& theory);

/// A program that has not answered in time. Nothing more is asked of it: every answer would cost as much
/// again.
struct LateProgram {
  const BackendInfo* backend = nullptr;
  double seconds = 0;  ///< wall time that was lost with it
  std::string status;
};

/// What a method lacks that has no point, or no more.
enum class Lack {
  nothing,      ///< all that there is to measure is
  time,         ///< wall time
  stable_step,  ///< no step that was tried is stable
  backend       ///< the backend cannot run here, or not this, or fails
};

/// Steps are taken no longer than this share of the largest stable one, which was found to a fiftieth, by
/// other runs than that over the horizon.
inline constexpr double usable_share = 0.95;

/// An integrator, and the limit of its step.
struct StepLimit {
  const Integrator* integrator = nullptr;
  std::string backend;       ///< that the limit was found with
  double first_seconds = 0;  ///< wall time to make that backend with the step that was tried first
  double step_seconds = 0;   ///< and of a step then
  StableStep measured;
  StepTheory theory;
  bool floor_is_why = false;      ///< the shortest unstable step is stable where there is no floor
  std::string why;                ///< why the two differ, or nothing
  std::string status;             ///< why nothing was measured; empty where it was
  std::vector<LateProgram> late;  ///< that were tried

  Lack lack() const {
    if (!status.empty()) return Lack::backend;
    if (measured.stable_s > 0) return Lack::nothing;
    return measured.finished ? Lack::stable_step : Lack::time;
  }
  /// The longest step to take, s; 0: none is known to be stable.
  double usable_s() const { return usable_share * measured.stable_s; }
};

/// A point of a method's curve that there was no time for.
struct NextPoint {
  double seconds = 0;  ///< wall time to measure it, about
  double dt_s = 0;     ///< its step
};

/// An integrator on a backend.
struct GuidedMethod {
  const Integrator* integrator = nullptr;
  const BackendInfo* backend = nullptr;
  std::string status;  ///< why there is no point, or why there are no more; empty: all there is to measure is
  std::vector<LateProgram> late = {};  ///< the backend's program, where it is
  Lack lack = Lack::nothing;
  double step_seconds = 0;  ///< wall time of a step of the shortest size that was timed; 0: none was
  std::optional<NextPoint> next = {};
};

/// Is the point of the method?
inline bool is_of(const WorkPoint& point, const GuidedMethod& method) {
  return point.integrator == method.integrator && point.backend == method.backend->name;
}

/// Does something with a backend. False where it cannot run here or not this, or where the program behind it
/// fails; `status` says why.
template <class Work>
bool succeeds(const BackendInfo& backend, std::string& status, std::vector<LateProgram>& late,
              const Work& work) {
  const Stopwatch watch;
  try {
    work();
    return true;
  } catch (const Unsupported& reason) {
    status = std::string("unsupported: ") + reason.what();
  } catch (const Unavailable& reason) {
    status = std::string("unavailable: ") + reason.what();
  } catch (const BackendFailure& reason) {
    status = std::string("failed: ") + reason.what();
    if (reason.late) late.push_back({&backend, watch.seconds(), status});
  }
  return false;
}

/// How long steps take.
struct StepTime {
  double seconds = 0;  ///< a step, in the fastest of the runs: other programs only ever add to one
  int runs = 0;
};

/// Times runs of `steps` steps from the system's start, after one of at most ten that is not counted, until
/// they have taken `enough_s` and are five, or have taken ten times that; one at least. Where the first run
/// alone takes that long with all the steps, it is the only one. Only step() is timed.
StepTime time_steps(Backend& backend, const System& system, int steps, double enough_s);

/// Wall time that time_steps takes, about, where a run takes `run_s`.
double seconds_of_runs(double run_s, double enough_s);

/// Wall time of a step, from a few.
double seconds_of_step(Backend& backend, const System& system);

/// What the limits of steps are looked for with.
struct LimitRequest {
  const System* system = nullptr;
  std::vector<const BackendInfo*> backends;
  ExecutionOptions execution;
  Spectrum at_start, on_the_way;
  double seconds = 0;  ///< wall time for an integrator, about; what goes beyond has found no stable step yet
  std::function<bool()> stop;
};

/// Simulated time of a run that decides whether a step is stable, where its wall time suffices.
inline constexpr double stability_span_s = 0.2;

/// Measures the integrator's largest stable step, on the first of the backends that runs it, and says why
/// theory differs. `openmp` comes first: it is the fastest almost everywhere, and the limit is the method's
/// and not the backend's.
StepLimit find_step_limit(const Integrator& integrator, const LimitRequest& request);

}  // namespace mssim
