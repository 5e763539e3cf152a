#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "guide/trusted_state.h"
#include "guide/work_point.h"

namespace mssim {

/// Where a point of an implicit method ended.
struct ImplicitEnd {
  std::size_t point = 0;  ///< its index
  State state;            ///< at the horizon
};

/// Tells the errors of implicit points apart: the solver's from the step's. Between them stands exact
/// backward Euler with the same step: newton-euler in double precision until it gains nothing more. The steps
/// that newton-euler itself took the least time for go first, until `stop` says so; what is left has no such
/// errors, nor has what newton-euler does not run or that diverges.
void tell_errors_apart(std::span<WorkPoint> points, std::span<const ImplicitEnd> ends, const System& system,
                       const TrustedState& trusted, const std::function<bool()>& stop);

}  // namespace mssim
