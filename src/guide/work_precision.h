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

/// The state of a system `span_s` after its start, in double precision, by a solver that shares nothing with
/// the table of integrators but the laws of springs and acceleration: Boost.Odeint's Bulirsch-Stoer method
/// (extrapolated modified midpoint rules of variable order and step; Hairer, Norsett and Wanner, Solving
/// Ordinary Differential Equations I, section II.9). `tolerance`: the error of a step, absolute, of
/// positions in m and velocities in m/s. The floor does not act. None where `stop` ended it
/// between two of its steps, or where it found no step that is small enough.
std::optional<State> independent_state(const System& system, double span_s, double tolerance,
                                       const std::function<bool()>& stop);

/// What a trusted state is asked for with.
struct TrustedRequest {
  double longest_s = 0;        ///< simulated time that it is to be after the start, at most
  double first_dt_s = 0;       ///< of rk4, which starts with it; well below its stability limit
  double seconds = 0;          ///< wall time that it may take, about
  double wanted_error = 2e-7;  ///< its own, in mean rest lengths: the step is halved until it is reached
  std::function<bool()> stop = [] { return false; };
};

/// Neighbouring trajectories may part by this factor within a horizon. Where they part by more, an error at
/// its end says how chaotic the motion is and not how good a step was: what single precision rounds grows as
/// much.
inline constexpr double allowed_parting = 10;

/// Errors that are shown are at least so many times as large as the trusted state's own.
inline constexpr double trusted_margin = 50;

/// Where the nodes really are a while after the start: what errors are measured against.
struct TrustedState {
  double horizon_s = 0;   ///< how long after the start
  std::string why_there;  ///< what ended the horizon, in words without a full stop
  double parting = 0;     ///< factor by which a neighbouring trajectory was farther away at its end
  double dt_s = 0;        ///< of rk4, the last and smallest
  State state;
  Energy energy;
  double own_error = 0;  ///< in mean rest lengths, from the last halving
  std::optional<double>
      confirmed;        ///< largest distance from what the independent solver found; none: no time
  std::string failure;  ///< why there is none; then all else but short_of_s is empty
  /// Wall seconds that a longer or better reference would have taken, where there was no time for it.
  double short_of_s = 0;

  /// The larger of the two, which errors that are shown exceed trusted_margin times.
  double error() const { return confirmed && *confirmed > own_error ? *confirmed : own_error; }
};

/// Classical Runge-Kutta in double precision (backends/backends.h), twice or more often, each time with half
/// the step: two results of order 4 differ by 15 times the error of the better one (Hairer, Norsett and
/// Wanner, Solving Ordinary Differential Equations I, section II.4, Richardson). Then another solver
/// (independent_state) must come to the same. The horizon ends before a node meets the floor, since after
/// a bounce results differ by a step's worth of landing time; and before a trajectory that starts 1e-7 mean
/// rest lengths beside it has parted by more than allowed_parting.
TrustedState trusted_state(const System& system, const TrustedRequest& request);

/// Marks the points that no other one beats: one that counts and is no slower, no less accurate and, in one
/// of the two, better. Points that do not count are never on the front.
void mark_pareto_front(std::span<WorkPoint> points);

/// Where a point of an implicit method ended.
struct ImplicitEnd {
  std::size_t point = 0;  ///< its index
  State state;            ///< at the horizon
};

/// Tells the errors of implicit points apart: the solver's from the step's. Between them stands exact
/// backward Euler with the same step: newton-euler in double precision until it gains nothing more. The steps
/// that newton-euler itself took the least time for go first, until `stop` says so; what is left has no such
/// errors, nor has what newton-euler does not run or that diverges.
void tell_errors_apart(std::span<WorkPoint> points, std::span<const ImplicitEnd> ends, const System& system,
                       const TrustedState& trusted, const std::function<bool()>& stop);

/// A point of a curve, and where it ended.
struct MeasuredPoint {
  WorkPoint point;
  State state;  ///< at the horizon
};

/// A work-precision curve, from its coarsest step on.
class WorkCurve {
 public:
  /// `limit`: of the method's integrator; all must outlive it. `wanted_error`: no point is taken beyond a
  /// quarter of it.
  WorkCurve(const System& system, const TrustedState& trusted, const StepLimit& limit, GuidedMethod& method,
            const ExecutionOptions& execution, double wanted_error);

  /// Wall seconds that the next point takes, about: the first of an implicit method, and of one whose step
  /// was not timed, as if it ran on the backend of the limit.
  double next_seconds() const { return next_seconds_; }
  bool has_next() const { return has_next_; }
  /// Takes no more points, for this reason.
  void end(Lack lack, std::string_view why);
  /// Takes no more points, because there is no time for the next one.
  void end_without_time();
  /// Whether the next point takes what a step on this backend says.
  bool is_timed() const { return method_.step_seconds > 0; }
  /// Times a step of an explicit method. Where the backend does not run, or fails, the curve ends.
  void time_step();
  /// Measures the next point, with half the step of the one before. None where the backend does not run, or
  /// fails; method.status says why.
  std::optional<MeasuredPoint> next();
  /// Measures the point of so many steps over the horizon, beside the others. None as above.
  std::optional<MeasuredPoint> measure(int steps);
  /// Wall seconds that measure() takes, about, once the step is timed.
  double seconds_of(int steps) const;

 private:
  /// Says in the method's status why not, where that is not for the points that there are.
  bool goes_on_after(const WorkPoint& point);

  const System& system_;
  const TrustedState& trusted_;
  GuidedMethod& method_;
  ExecutionOptions execution_;
  double wanted_error_, stable_s_;
  int steps_;
  int points_ = 0;
  bool has_next_ = true, counted_ = false;
  double setup_seconds_, next_seconds_ = 0;
  std::optional<double> last_error_;
};

/// Steps of the coarsest point of a curve: of an explicit method twice the largest stable step, so that the
/// first point shows that this diverges; of an implicit one the longest step that is of use, the same for all
/// of them, so that they share exact backward Euler.
int first_steps(const Integrator& integrator, const StableStep& limit, double horizon_s);

}  // namespace mssim
