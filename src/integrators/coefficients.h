#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <type_traits>
#include <utility>

#include "integrators/all_integrators.h"

namespace mssim {

/// [stage][assignment][term] coefficient * dt^dt_power of every term, evaluated once in double and rounded
/// once to Real, so the loops multiply by one number.
template <class Real>
using Coefficients = std::array<std::array<std::array<Real, max_terms>, max_assignments>, max_stages>;

/// The coefficients of an explicit integrator for steps of dt_s (s).
template <class Real>
Coefficients<Real> coefficients_of(const Integrator& integrator, double dt_s) {
  Coefficients<Real> result{};
  for (std::size_t s = 0; s < max_stages; ++s)
    for (std::size_t l = 0; l < max_assignments; ++l)
      for (std::size_t t = 0; t < max_terms; ++t) {
        const Term& term = integrator.stages[s].assignments[l].terms[t];
        result[s][l][t] = static_cast<Real>(term.coefficient * std::pow(dt_s, term.dt_power));
      }
  return result;
}

/// Calls `visit(std::integral_constant<std::size_t, I>)`, where I is the row of `integrator` in the table of
/// stages, so loops can be instantiated from the row. `integrator` must be explicit.
template <class Visit>
void with_integrator(const Integrator& integrator, Visit&& visit) {
  const Integrator* const taken = integrator.row != nullptr ? integrator.row : &integrator;
  [&]<std::size_t... row>(std::index_sequence<row...>) {
    (void)((&integrators[row] == taken ? (visit(std::integral_constant<std::size_t, row>{}), true) : false) ||
           ...);
  }
  (std::make_index_sequence<integrators.size()>{});
}

/// Calls `visit(std::integral_constant<std::size_t, S>)` for each stage in order.
template <std::size_t row, class Visit>
constexpr void for_each_stage(Visit&& visit) {
  [&]<std::size_t... stage>(std::index_sequence<stage...>) {
    (visit(std::integral_constant<std::size_t, stage>{}), ...);
  }
  (std::make_index_sequence<integrators[row].stage_count>{});
}

}  // namespace mssim
