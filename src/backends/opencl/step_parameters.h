#pragma once

#include <cstring>

#include "backends/interface/backend.h"
#include "integrators/coefficients.h"
#include "kernels/step_parameters.h"

namespace mssim {

/// What the kernels of every topology are told about a step of dt_s.
inline StepParameters step_parameters_of(const System& system, const Integrator& integrator, double dt_s) {
  StepParameters step{};
  step.surroundings = surroundings_of(system);
  const Coefficients<float> coefficients = coefficients_of<float>(integrator, dt_s);
  static_assert(sizeof(coefficients) == sizeof(step.coefficients));
  std::memcpy(step.coefficients, coefficients.data(), sizeof(step.coefficients));
  return step;
}

}  // namespace mssim
