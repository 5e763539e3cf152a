#pragma once

#include <optional>
#include <string>

#include "backends/backends.h"
#include "guide/stable_step.h"
#include "guide/step_theory.h"
#include "guide/work_point.h"

namespace mssim {

/// An integrator, and the limit of its step.
struct StepLimit {
  const Integrator* integrator = nullptr;
  std::string backend;       ///< that the limit was found with
  double first_seconds = 0;  ///< wall time to make that backend with the step that was tried first
  double step_seconds = 0;   ///< and of a step then
  StableStep measured;
  StepTheory theory;
  bool floor_is_why = false;  ///< the shortest unstable step is stable where there is no floor
  std::string why;            ///< why the two differ, or nothing
  std::string status;         ///< why nothing was measured; empty where it was
};

/// An integrator on a backend.
struct GuidedMethod {
  const Integrator* integrator = nullptr;
  const BackendInfo* backend = nullptr;
  std::string status;  ///< why there is no point, or why there are no more; empty: all there is to measure is
};

/// Is the point of the method?
inline bool is_of(const WorkPoint& point, const GuidedMethod& method) {
  return point.integrator == method.integrator && point.backend == method.backend->name;
}

/// Makes the backend, or says in `status` why it cannot run here or not this.
inline std::unique_ptr<Backend> try_to_make(const BackendInfo& backend, const System& system,
                                            const Integrator& integrator, double dt_s,
                                            const ExecutionOptions& execution, std::string& status) {
  try {
    return make_backend(backend, system, integrator, dt_s, execution);
  } catch (const Unsupported& reason) {
    status = std::string("unsupported: ") + reason.what();
  } catch (const Unavailable& reason) {
    status = std::string("unavailable: ") + reason.what();
  } catch (const BackendFailure& reason) {
    status = std::string("failed: ") + reason.what();
  }
  return nullptr;
}

}  // namespace mssim
