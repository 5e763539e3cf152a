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

/// The number of steps over the horizon with which the method should keep the requested error, if their
/// length exceeds that of its point_at_error by more than step_resolution. It follows from the curve, or is
/// that of the largest usable step if the curve is accurate enough at its longest step. None if no point
/// keeps the error.
std::optional<int> steps_to_try(const SceneGuide& guide, const GuidedMethod& method);

/// Explicit methods that could be the cheapest at the requested error, but whose curves had no time to reach
/// it. The step that such a method needs follows from its integrator's finest point that counts, on any
/// backend, and its order; it is at most the largest usable step. With that step and the measured time per
/// step, the method is cheaper than all measured ones. A method also counts if its step or time is unknown,
/// but not if its integrator's curve on another backend is complete and does not reach the error. Implicit
/// methods, whose cost per step is not known in advance, count only if there are no such explicit methods and
/// no point counts.
std::vector<const GuidedMethod*> missed_methods(const SceneGuide& guide);

/// Wall time, s, with which the curves of these methods would have reached the requested error, with the
/// points of other methods that take no longer; no curve gets more points than NextPoint::later. Rounded up
/// to two digits, and at least twice the time of the request. A lower bound if the horizon ended for lack of
/// time.
double needed_seconds(const SceneGuide& guide, std::span<const GuidedMethod* const> missed);

/// The positive number, rounded up to two digits.
double rounded_up(double value);

}  // namespace mssim
