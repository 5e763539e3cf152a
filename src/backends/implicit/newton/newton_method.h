#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "integrators/integrator.h"
#include "model/system.h"
#include "text/text.h"

namespace mssim {

/// Goals at which the methods below stop.
struct SolverGoal {
  double tolerance = 0;  ///< relative: of newton_step to the initial norm, of newtons_method to that of w - v
  double rounding = 0;   ///< kg^1/2 m/s; the norm of r stays above it because of rounded forces
  double rounding_of_motion = 0;  ///< contribution of rounded velocities, relative to sqrt(w . M w)
};

/// Largest error of a spring's force, in u k L: (k - k L / l) d is rounded at d, 1 / l and the products with
/// k L and with d.
inline constexpr double roundings_of_force = 4;

/// The goal of a solver that computes springs in precision Real. Each error below varies from spring to
/// spring or from node to node, so squares are summed; u is half a unit in the last place of 1.
///
/// A spring's force is the difference of k l and k L, each rounded: an error of u k L. Newton's method on the
/// shipped cloths reaches a third of this, and no less.
///
/// Rounding w_j by u |w_j| changes r by column j of A. With a = dt c + dt^2 k of a spring, the largest
/// eigenvalue of its part of A, its square in the norm of M^-1  is at most
///     (m_j + dt viscous_damping m_j + sum of a)^2 / m_j + sum of a^2 / m_i
/// over the springs from j to i, times u^2 |w_j|^2; the largest of it over m_j |w_j|^2 is taken for all
/// nodes. That is an upper bound: not a goal, but a test whether a norm no longer falls because of rounding.
template <class Real>
SolverGoal solver_goal(const System& system, double dt_s, double tolerance) {
  constexpr double unit_roundoff = static_cast<double>(std::numeric_limits<Real>::epsilon()) / 2;
  double sum = 0;
  std::vector<double> diagonal, others(system.nodes());
  for (const double mass : system.node_mass) diagonal.push_back(mass * (1 + dt_s * system.viscous_damping));
  for (const Spring& spring : system.springs) {
    const auto law = linear_spring(system.materials[spring.kind], static_cast<double>(spring.rest_length));
    const double tension = law.stiffness_rest, along = spring_step_along(dt_s, law.constants);
    for (const auto& [end, other] : {std::pair{spring.first, spring.second}, {spring.second, spring.first}}) {
      sum += tension * tension / system.node_mass[end];
      diagonal[end] += along;
      others[end] += along * along / system.node_mass[other];
    }
  }
  double column = 0;
  for (std::size_t i = 0; i < system.nodes(); ++i) {
    const double mass = system.node_mass[i];
    column = std::max(column, (diagonal[i] * diagonal[i] / mass + others[i]) / mass);
  }
  return {tolerance, unit_roundoff * dt_s * std::sqrt(sum), unit_roundoff * std::sqrt(column)};
}

/// The equation of one step of backward Euler, as required by the methods below. Its unknown is w, the
/// velocities at the step's end:
///
///     r(w) = M (w - v) - dt F(x + dt w, w) = 0.
///
/// A is the Jacobian of r, made symmetric and positive definite (kernels/spring_law.h); P, its
/// preconditioner, is the inverse of its 3 x 3 blocks on the diagonal. In the following, s is the change of w
/// that A s = e gives, p a direction of conjugate gradients and q = A p. P is zero for pinned nodes, and so
/// are their s and p, and they are omitted from products of vectors. Those are sums in double precision. If
/// several threads run a method together, each must get the same sums.
template <class Equation>
concept BackwardEulerEquation = requires(Equation& equation, double factor) {
  /// w = v.
  equation.begin();
  /// e = dt (F(x, v) + dt dF/dx v), and A, both at the state: Baraff and Witkin 1998, Eq. 6.
  equation.linearise_at_state();
  /// e = -r(w), and A at (x + dt w, w). Returns e . M^-1 e.
  { equation.linearise() } -> std::same_as<double>;
  /// s = 0, p = 0, z = P e. Returns e . z.
  { equation.start_solving() } -> std::same_as<double>;
  /// p = z + factor p, q = A p. Returns p . q.
  { equation.turn(factor) } -> std::same_as<double>;
  /// s += factor p, e -= factor q, z = P e. Returns e . z.
  { equation.advance(factor) } -> std::same_as<double>;
  /// w += factor s.
  equation.add(factor);
  /// e . s: negative if r has turned against s.
  { equation.along_solution() } -> std::same_as<double>;
  /// w . M w.
  { equation.motion() } -> std::same_as<double>;
  /// (w - v) . M (w - v).
  { equation.change() } -> std::same_as<double>;
  /// v = w, x += dt w, and the floor acts.
  equation.end();
};

/// The work of a solver's steps so far.
struct SolverWork {
  std::uint64_t steps = 0;
  std::uint64_t newton_iterations = 0;  ///< number of linear systems
  std::uint64_t products = 0;           ///< A p: iterations of conjugate gradients
  std::uint64_t unfinished_steps = 0;   ///< whose solver reached the limit of iterations or of its precision

  SolverWork& operator+=(const SolverWork& more) {
    steps += more.steps;
    newton_iterations += more.newton_iterations;
    products += more.products;
    unfinished_steps += more.unfinished_steps;
    return *this;
  }
};

/// Largest number of iterations of conjugate gradients for a linear system.
inline constexpr int most_gradient_iterations = 1000;
/// Across springs that a step compresses, A is not the Jacobian, and convergence is linear: a cloth whose
/// nodes move up to five rest lengths per step needs up to 94 iterations to 1e-5, and more to 1e-12.
inline constexpr int most_newton_iterations = 1000;

/// Result of conjugate gradients.
struct Solution {
  bool solved = false;  ///< to the tolerance
  double along = 0;     ///< e . s, of e at their start
};

/// Solves A s = e by preconditioned conjugate gradients from s = 0, until sqrt(e . P e) has decreased to
/// `tolerance` of its initial value. Not solved if that takes more than most_gradient_iterations, or if A or
/// P is not positive definite in its precision.
template <BackwardEulerEquation Equation>
Solution conjugate_gradients(Equation& equation, double tolerance, SolverWork& work) {
  double left = equation.start_solving();
  const double goal = tolerance * tolerance * left;
  double factor = 0, along = 0;
  for (int i = 0; left > goal; ++i) {
    if (i == most_gradient_iterations) return {false, along};
    ++work.products;
    const double curvature = equation.turn(factor);
    if (!(curvature > 0)) return {false, along};
    const double part = left / curvature;
    along += part * left;  // initial p . e = e . z: later directions are conjugate to the solution so far
    const double next = equation.advance(part);
    factor = next / left;
    left = next;
  }
  return {left >= 0 && left <= goal && std::isfinite(goal), along};
}

/// A step by one Newton iteration from the state, with its linear system solved to `tolerance`.
template <BackwardEulerEquation Equation>
void newton_step(Equation& equation, double tolerance, SolverWork& work) {
  equation.begin();
  equation.linearise_at_state();
  ++work.newton_iterations;
  if (!conjugate_gradients(equation, tolerance, work).solved) ++work.unfinished_steps;
  equation.add(1);
  equation.end();
  ++work.steps;
}

/// A step by Newton's method from w = v, until the norm of r, sqrt(r . M^-1 r), reaches the goal, or until
/// rounding stops its decrease. The goal is relative to sqrt((w - v) . M (w - v)): no eigenvalue of M^-1 A is
/// below 1, so the relative error of w - v is not larger, whatever the step, if no spring is compressed. (A
/// goal relative to the first r would not ensure that: the longer the step, the more of it is due to stiff
/// springs.) Linear systems are solved to a tolerance relative to the current r (an inexact Newton method:
/// Dembo, Eisenstat and Steihaug 1982).
///
/// A fraction of s is accepted if it reduces r, or if it does not lead far uphill. Without damping, r is the
/// gradient with respect to w of (w - v) . M (w - v) / 2 + E(x + dt w), where E is the elastic and
/// gravitational energy; its minimum is sought, and s initially leads downhill, because A is positive
/// definite. A decrease of r cannot be required: A is not its Jacobian across compressed springs, so r may
/// grow along every fraction of s, however short.
template <BackwardEulerEquation Equation>
void newtons_method(Equation& equation, const SolverGoal& goal, SolverWork& work) {
  constexpr double forcing = 0.01, shortest = 1. / 64, most_uphill = 0.5;
  equation.begin();
  double norm = equation.linearise();
  const auto is_small = [&] {
    return norm <= goal.rounding * goal.rounding ||
           norm <= goal.tolerance * goal.tolerance * equation.change();
  };
  for (int i = 0; !is_small(); ++i) {
    if (i == most_newton_iterations) {
      ++work.unfinished_steps;
      break;
    }
    ++work.newton_iterations;
    const double descent = conjugate_gradients(equation, forcing, work).along;
    double part = 1;
    equation.add(part);
    double next = equation.linearise();
    if (!(next < norm)) {
      const double rounding =
          roundings_of_force * goal.rounding + goal.rounding_of_motion * std::sqrt(equation.motion());
      const bool is_rounding = next <= rounding * rounding;
      if (is_rounding || !(descent > 0)) {  // s is 0: it would stay so
        if (!is_rounding) ++work.unfinished_steps;
        equation.add(-part);
        break;
      }
    }
    while (!(next < norm) && part > shortest && !(equation.along_solution() > -most_uphill * descent)) {
      part /= 2;
      equation.add(-part);
      next = equation.linearise();
    }
    norm = next;
  }
  equation.end();
  ++work.steps;
}

/// A step of implicit-euler or newton-euler.
template <BackwardEulerEquation Equation>
void take_step(Equation& equation, const Integrator& integrator, const SolverGoal& goal, SolverWork& work) {
  if (integrator.solver == Solver::newton_step)
    newton_step(equation, goal.tolerance, work);
  else
    newtons_method(equation, goal, work);
}

/// A note for readers of times if the solver has reached a limit; else empty.
inline std::string note_of(const SolverWork& work) {
  if (work.unfinished_steps == 0) return {};
  return fmt::format("the solver ended before its tolerance in {} of {}", work.unfinished_steps,
                     pluralize(work.steps, "step"));
}

}  // namespace mssim
