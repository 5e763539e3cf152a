#pragma once

#include <optional>
#include <string>
#include <vector>

#include "backends/backends.h"
#include "guide/stable_step.h"
#include "guide/step_theory.h"
#include "guide/work_point.h"
#include "platform/machine.h"

namespace mssim {

/// A program that has not answered in time. Nothing more is asked of it: every answer would cost as much
/// again.
struct LateProgram {
  const BackendInfo* backend = nullptr;
  double seconds = 0;  ///< wall time that was lost with it
  std::string status;
};

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
};

/// An integrator on a backend.
struct GuidedMethod {
  const Integrator* integrator = nullptr;
  const BackendInfo* backend = nullptr;
  std::string status;  ///< why there is no point, or why there are no more; empty: all there is to measure is
  std::vector<LateProgram> late = {};  ///< the backend's program, where it is
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

}  // namespace mssim
