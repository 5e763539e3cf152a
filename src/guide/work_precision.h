#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "backends/interface/backend.h"
#include "guide/guided_method.h"
#include "guide/trusted_state.h"
#include "guide/work_point.h"

namespace mssim {

/// Exact backward Euler over the horizon: newton-euler in double precision until it gains nothing more, for
/// each number of steps at most once.
class ExactBackwardEuler {
 public:
  /// All states together may take about `seconds`; both must outlive it.
  ExactBackwardEuler(const System& system, const TrustedState& trusted, double seconds)
      : system_(system), trusted_(trusted), seconds_left_(seconds) {}

  /// Its state after that many steps to the horizon; null where newton-euler does not run, or takes too long.
  const State* after(int steps);

 private:
  const System& system_;
  const TrustedState& trusted_;
  double seconds_left_;
  double step_seconds_ = 0;  ///< of the last state that was computed
  std::map<int, std::optional<State>> states_;
};

/// A work-precision curve, from its coarsest step on.
class WorkCurve {
 public:
  /// `limit`: of the method's integrator. `exact`: for implicit ones; all must outlive it. `wanted_error`: no
  /// point is taken beyond a quarter of it.
  WorkCurve(const System& system, const TrustedState& trusted, const StepLimit& limit, GuidedMethod& method,
            const ExecutionOptions& execution, ExactBackwardEuler& exact, double wanted_error);

  /// Wall seconds that the next point takes, about; 0 where nothing is known yet.
  double next_seconds() const;
  bool has_next() const { return has_next_; }
  /// Takes no more points, for this reason.
  void end(std::string_view why);
  /// Measures the next point, with half the step of the one before. None where the backend does not run;
  /// method.status says why.
  std::optional<WorkPoint> next();

 private:
  bool goes_on_after(const WorkPoint& point) const;

  const System& system_;
  const TrustedState& trusted_;
  GuidedMethod& method_;
  ExecutionOptions execution_;
  ExactBackwardEuler& exact_;
  double wanted_error_, stable_s_;
  int steps_;
  int points_ = 0;
  bool has_next_ = true;
  double last_seconds_ = 0;
  std::optional<double> last_error_;
};

/// Steps of the coarsest point of a curve: of an explicit method twice the largest stable step, so that the
/// first point shows that this diverges; of an implicit one the longest step that is of use, the same for all
/// of them, so that they share exact backward Euler.
int first_steps(const Integrator& integrator, const StableStep& limit, double horizon_s);

/// The longest step that is tried, s: a frame of the slowest rate that is asked about.
inline constexpr double longest_useful_step_s = 1.0 / 30;

}  // namespace mssim
