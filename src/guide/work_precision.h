#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "backends/interface/backend.h"
#include "guide/limits.h"
#include "guide/trusted_state.h"

namespace mssim {

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

  /// Wall seconds that the next point takes, about: the first as if it ran on the backend of the limit.
  double next_seconds() const { return next_seconds_; }
  bool has_next() const { return has_next_; }
  /// Takes no more points, for this reason.
  void end(std::string_view why);
  /// Measures the next point, with half the step of the one before. None where the backend does not run, or
  /// fails; method.status says why.
  std::optional<MeasuredPoint> next();

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
  bool has_next_ = true;
  double next_seconds_;
  std::optional<double> last_error_;
};

/// Steps of the coarsest point of a curve: of an explicit method twice the largest stable step, so that the
/// first point shows that this diverges; of an implicit one the longest step that is of use, the same for all
/// of them, so that they share exact backward Euler.
int first_steps(const Integrator& integrator, const StableStep& limit, double horizon_s);

}  // namespace mssim
