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

/// The method's longest step that keeps the error, else its cheapest stable point; null without any.
const WorkPoint* point_for_sizes(const SceneGuide& guide, const GuidedMethod& method);

/// The integrator's limit of stability; null if it was not looked for.
const StepLimit* limit_of(const SceneGuide& guide, const Integrator* integrator);

/// The longest step, s, with which the integrator should keep the requested error; none if no measurement
/// shows it.
std::optional<double> expected_step(const SceneGuide& guide, const Integrator& integrator);

}  // namespace mssim
