#pragma once

#include <optional>
#include <string>
#include <vector>

#include "backends/interface/backend.h"
#include "guide/guided_method.h"
#include "guide/trusted_state.h"
#include "guide/work_point.h"

namespace mssim {

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

/// The longest step that is tried, s: a frame of the slowest rate that is asked about.
inline constexpr double longest_useful_step_s = 1.0 / 30;

}  // namespace mssim
