#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "guide/scene_guide.h"

namespace mssim {

/// What a method takes where its error may be this large.
struct CostAtError {
  double seconds_a_second = 0;  ///< wall time of a simulated second
  /// It is that of the coarsest point that counts, which is more accurate than asked: a longer step was not
  /// stable, or not tried.
  bool at_longest_step = false;
};

/// Between two points of the curve the logarithm of the cost is taken as linear in that of the error; none
/// where no point is accurate enough. Points that do not count are left out.
std::optional<CostAtError> cost_at_error(std::span<const WorkPoint> points, const GuidedMethod& method,
                                         double error);

/// Errors at which costs are shown, from large to small: the wished one and three around it.
std::array<double, 4> errors_around(const Wish& wish);

/// What Hong et al. say of integrators by milliseconds a step, beside what was measured at the wished error:
/// sentences with their full stops. For each backend the order of semi-euler, midpoint and rk4; and what
/// becomes of explicit Euler, which they leave out because it "can be readily blow-up". Empty where none of
/// it was measured.
std::vector<std::string> beside_the_paper(const SceneGuide& guide);

}  // namespace mssim
