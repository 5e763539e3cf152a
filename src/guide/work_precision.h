#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "backends/interface/backend.h"
#include "guide/limits.h"
#include "model/system.h"

namespace mssim {

/// Cost and error of one step size: a point of a work-precision curve (Hairer, Norsett and Wanner, Solving
/// Ordinary Differential Equations I, section II.10).
struct WorkPoint {
  int steps = 0;              ///< over the horizon
  double dt_s = 0;            ///< simulated time
  double seconds_a_step = 0;  ///< wall time, in the fastest of `samples` runs over the horizon
  int samples = 0;
  /// Force evaluations per step: the stages of an explicit method, the iterations of fast-springs, the small
  /// steps of xpbd. None for methods with conjugate gradients, whose number varies from step to step.
  std::optional<double> evaluations;
  bool diverged = false;  ///< not finite, or with more energy than energy_bound allows
  /// The step is no longer than the largest that was stable in runs. These may be longer than the horizon: a
  /// motion that does not diverge within the horizon may do so when it reaches the floor.
  bool within_limit = true;
  /// Largest distance from the trusted state at the horizon, in mean rest lengths; none if not finite.
  std::optional<double> position_error;
  std::optional<double> energy_error;  ///< of the total energy, over the trusted kinetic + elastic energy
  /// Errors of an implicit method, in mean rest lengths, if there was time to separate them. The solver's is
  /// the distance from exact backward Euler with the same step; the step's is the distance of exact backward
  /// Euler from the trusted state.
  std::optional<double> solver_error, step_error;
  bool beyond_trust = false;  ///< the error is below trusted_margin times the trusted state's own
  bool on_front = false;      ///< no other point is both as fast and as accurate (mark_pareto_front)
  std::string note;           ///< of the backend

  /// Wall time of a simulated second, s.
  double seconds_a_second() const { return seconds_a_step / dt_s; }
  /// Whether conclusions may use the point.
  bool counts() const { return !diverged && within_limit && !beyond_trust && position_error.has_value(); }
};

/// A point of a method's curve for which there was no time.
struct NextPoint {
  double seconds = 0;  ///< approximate wall time to measure it
  double dt_s = 0;     ///< its step
  int later = 0;       ///< points that the curve may have after it
};

/// A method: an integrator on a backend, and its work-precision curve.
struct GuidedMethod {
  const Integrator* integrator = nullptr;
  const BackendInfo* backend = nullptr;
  Ending ending = {};       ///< why there are no points, or no more
  double step_seconds = 0;  ///< wall time per step of the shortest step that was timed; 0: none
  std::optional<NextPoint> next = {};
  std::vector<WorkPoint> points = {};  ///< from coarse to fine, once all are measured
};

/// The state of a system `span_s` after its start, in double precision, by a solver that shares only the laws
/// of springs and acceleration with the table of integrators: Boost.Odeint's Bulirsch-Stoer method
/// (extrapolated modified midpoint rules of variable order and step; Hairer, Norsett and Wanner, Solving
/// Ordinary Differential Equations I, section II.9). `tolerance`: absolute error per step of positions in m
/// and velocities in m/s. The floor does not act. None if `stop` ended it between two steps, or if no step
/// was small enough.
std::optional<State> independent_state(const System& system, double span_s, double tolerance,
                                       const std::function<bool()>& stop);

/// A request for a trusted state.
struct TrustedRequest {
  double longest_s = 0;        ///< longest simulated time after the start
  double first_dt_s = 0;       ///< first step of rk4; well below its stability limit
  double seconds = 0;          ///< approximate wall time
  double wanted_error = 2e-7;  ///< in mean rest lengths; the step is halved until this is reached
  std::function<bool()> stop = [] { return false; };
};

/// Factor by which the distance of neighbouring trajectories may grow within a horizon. If it grows by more,
/// the error at the end shows how chaotic the motion is, not how good a step was: rounding errors of single
/// precision grow as much.
inline constexpr double allowed_parting = 10;

/// Smallest ratio of an error that is shown to the trusted state's own.
inline constexpr double trusted_margin = 50;

/// The reference for errors: the positions of the nodes some time after the start.
struct TrustedState {
  double horizon_s = 0;   ///< simulated time after the start
  std::string why_there;  ///< what ended the horizon, without a full stop
  double parting = 0;     ///< factor by which the distance of a neighbouring trajectory has grown
  double dt_s = 0;        ///< last and smallest step of rk4
  State state;
  Energy energy;
  double own_error = 0;             ///< in mean rest lengths, from the last halving
  std::optional<double> confirmed;  ///< largest distance from the independent solver's state; none: no time
  std::string failure;              ///< why there is no state; then all else but short_of_s is empty
  /// Wall seconds that a longer or better reference would have taken; 0: there was time for it.
  double short_of_s = 0;

  /// The larger of own_error and confirmed; errors that are shown exceed it trusted_margin times.
  double error() const { return confirmed && *confirmed > own_error ? *confirmed : own_error; }
  /// The smallest error that is compared.
  double least_error() const { return trusted_margin * error(); }
};

/// Computes a trusted state by classical Runge-Kutta in double precision (backends/backends.h), at least
/// twice, each time with half the step: two results of order 4 differ by 15 times the error of the better one
/// (Hairer, Norsett and Wanner, Solving Ordinary Differential Equations I, section II.4, Richardson). An
/// independent solver confirms it (independent_state). The horizon ends before a node reaches the floor,
/// because the time of landing depends on the step, and before the distance of a trajectory that starts 1e-7
/// mean rest lengths away has grown by more than allowed_parting.
TrustedState trusted_state(const System& system, const TrustedRequest& request);

/// Marks the points that no other point of any method dominates. A point dominates if it counts, is neither
/// slower nor less accurate, and is better in one of the two. Points that do not count are never on the
/// front.
void mark_pareto_front(std::span<GuidedMethod> methods);

/// The final state of a point of an implicit method.
struct ImplicitEnd {
  GuidedMethod* method = nullptr;
  std::size_t point = 0;  ///< index of the method's point
  State state;            ///< at the horizon
};

/// Separates the errors of implicit points into the solver's and the step's, by exact backward Euler with the
/// same step: newton-euler in double precision, iterated until it no longer improves. Steps for which
/// newton-euler took the least time come first, until `stop`. The other points have no such errors, nor have
/// points that newton-euler does not run or for which it diverges.
void tell_errors_apart(std::span<GuidedMethod> methods, std::span<const ImplicitEnd> ends,
                       const System& system, const TrustedState& trusted, const std::function<bool()>& stop);

/// Measures the work-precision curve of a method, from its coarsest step on.
class WorkCurve {
 public:
  /// `limit`: of the method's integrator. All references must outlive the curve. `wanted_error`: the curve
  /// ends after a point with at most a quarter of it.
  WorkCurve(const System& system, const TrustedState& trusted, const StepLimit& limit, GuidedMethod& method,
            const ExecutionOptions& execution, double wanted_error);

  /// Approximate wall seconds of the next point. For the first point of an implicit method, or of one whose
  /// step was not timed, it assumes the backend of the limit.
  double next_seconds() const { return next_seconds_; }
  bool has_next() const { return has_next_; }
  GuidedMethod& method() const { return method_; }
  /// Ends the curve for this reason, unless it has another one.
  void end(const Ending& ending);
  /// Ends the curve because there is no time for the next point.
  void end_without_time();
  /// Whether a step on this backend has been timed.
  bool is_timed() const { return method_.step_seconds > 0; }
  /// Times a step of an explicit method. If the backend does not run, or fails, the curve ends.
  void time_step();
  /// Adds the next point to the method, with half the step of the one before, and returns its state at the
  /// horizon. None if the backend does not run, or fails; the method's ending gives the reason.
  std::optional<State> next();
  /// Adds a point of `steps` steps over the horizon, after the last of next(). None as for next().
  std::optional<State> measure(int steps);
  /// Approximate wall seconds of measure(), once a step is timed.
  double seconds_of(int steps) const;

 private:
  /// Whether the curve continues after its last point. If it ends before it is accurate enough, the method's
  /// ending says why.
  bool goes_on();
  /// Ends the curve if the error of its last point, which counts, shows that smaller steps do not help.
  bool ends_with_same_error();
  /// Whether any point counts.
  bool has_counted() const;
  /// Calls `run`. If the backend does not run, or fails, the curve ends.
  bool succeeds(const std::function<void()>& run);

  const System& system_;
  const TrustedState& trusted_;
  const StepLimit& limit_;
  GuidedMethod& method_;
  ExecutionOptions execution_;
  double wanted_error_;
  int steps_;
  int unchanged_ = 0;  ///< halvings in a row that left the error as it was
  bool has_next_ = true;
  double setup_seconds_, next_seconds_ = 0;
};

/// Number of steps of the coarsest point of a curve. An explicit method starts with twice the largest stable
/// step, so that its first point shows that it diverges. An implicit method starts with the longest useful
/// step, equal for all, so that they share exact backward Euler.
int first_steps(const Integrator& integrator, const StableStep& limit, double horizon_s);

}  // namespace mssim
