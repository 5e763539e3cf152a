#include "guide/step_theory.h"

#include <cmath>

#include "integrators/stability.h"
#include "text/text.h"

namespace mssim {
namespace {

constexpr double worth_a_word = 1.1;

std::string percent_more(double ratio) { return three_digits(100 * (ratio - 1)) + " %"; }

}  // namespace

StepTheory step_theory(const Integrator& integrator, const System& system, const Spectrum& start,
                       const Spectrum& reached) {
  const StiffnessBound bound = stiffness_bound(system);
  const double air = system.viscous_damping;
  return {largest_stable_dt(integrator, {start.stiffness, start.damping, air}),
          largest_stable_dt(integrator, {reached.stiffness, reached.damping, air}),
          largest_stable_dt(integrator, {bound.stiffness, bound.damping, air})};
}

bool is_shorter_than_theory(const StableStep& measured, const StepTheory& theory) {
  return measured.unstable_s > 0 && measured.stable_s * worth_a_word < theory.shortest_s();
}

std::string why_they_differ(const Integrator& integrator, const StableStep& measured,
                            const StepTheory& theory, bool floor_is_why) {
  if (measured.stable_s == 0 && !measured.finished) return "no time was left to find the limit";
  if (is_shorter_than_theory(measured, theory) && floor_is_why)
    return "the floor: a node that a step takes below it is put onto it, which strains its springs the more, "
           "the "
           "longer the step is; without the floor longer steps are stable";
  if (is_implicit(integrator)) {
    if (measured.unstable_s == 0) return {};
    return "backward Euler damps every linear mode at every step; a solver that stops before it has "
           "converged, and springs that fold, are not linear";
  }
  const double limit = theory.shortest_s();
  if (limit == 0 && measured.stable_s == 0) return {};
  if (limit == 0)
    return "theory finds modes that grow at every step, those that nothing but the air damps; they "
           "grow so slowly below the measured step that a run of " +
           three_digits(measured.span_s) +
           " s does not show it; a longer one is stable with shorter steps only";
  if (measured.stable_s == 0) return "no step that was tried was stable, though theory has one";
  if (measured.stable_s > worth_a_word * limit) {
    std::string why = "the measured step is " + percent_more(measured.stable_s / limit) + " longer: ";
    if (theory.on_the_way_s < limit * 1.0001 && theory.on_the_way_s * worth_a_word < theory.at_start_s)
      return why +
             "the strained state that theory is asked about has stiffer modes (springs stiffen sideways), "
             "which last too short for a run to blow up";
    return why +
           "theory counts a growth of one part in a million a step, which the undamped sideways modes "
           "reach first; a run shows only what grows faster";
  }
  if (is_shorter_than_theory(measured, theory))
    return "the measured step is " + percent_more(limit / measured.stable_s) +
           " shorter: springs that strain on the way stiffen sideways, where nothing damps them";
  return {};
}

}  // namespace mssim
