#pragma once

#include <functional>
#include <vector>

#include "guide/guided_method.h"
#include "model/spectrum.h"

namespace mssim {

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
