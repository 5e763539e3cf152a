#pragma once

#include <optional>
#include <span>
#include <vector>

#include "guide/guide.h"

namespace mssim {

/// A method and its cost at an error that it keeps.
struct Ranked {
  const GuidedMethod* method;
  CostAtError cost;
};

/// The methods that keep the error, the cheapest first.
std::vector<Ranked> by_cost(const SceneGuide& guide, double error);

/// The cheapest method after the first, with another integrator, else on another backend; null without one.
const Ranked* second_of(std::span<const Ranked> ranked);

/// The longest step, s, with which the method keeps the requested error (cost_at_error), else that of its
/// cheapest stable point; 0 without any.
double step_for_sizes(const SceneGuide& guide, const GuidedMethod& method);

/// The integrator's limit of stability; null if it was not looked for.
const StepLimit* limit_of(const SceneGuide& guide, const Integrator* integrator);

/// The longest step, s, with which the integrator should keep the requested error; none if no measurement
/// shows it.
std::optional<double> expected_step(const SceneGuide& guide, const Integrator& integrator);

/// The positive number, rounded up to two digits.
double rounded_up(double value);

}  // namespace mssim
