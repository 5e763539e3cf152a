#pragma once

#include <string>

#include "guide/stable_step.h"
#include "integrators/integrator.h"
#include "model/spectrum.h"

namespace mssim {

/// What linear theory says of an integrator's largest stable step, s; infinite for implicit integrators
/// (backward Euler is A-stable) and 0 where no step keeps every mode from growing.
struct StepTheory {
  double at_start_s = 0;    ///< with the spectrum at the scene's start
  double on_the_way_s = 0;  ///< with the spectrum of the strained state that a run reaches
  double bound_s = 0;       ///< with Gershgorin's bound in place of a spectrum, as `mssim check` has it
  double shortest_s() const { return at_start_s < on_the_way_s ? at_start_s : on_the_way_s; }
};

/// By the amplification that the integrator's stages have (integrators/stability.h). `reached`: the spectrum
/// of the strained state.
StepTheory step_theory(const Integrator& integrator, const System& system, const Spectrum& start,
                       const Spectrum& reached);

/// A sentence without a full stop that says why the measured step and theory differ; empty where they
/// are within 10 % of each other. `floor_is_why`: where the measured one is shorter, only the floor makes it
/// so.
std::string why_they_differ(const Integrator& integrator, const StableStep& measured,
                            const StepTheory& theory, bool floor_is_why);

/// Whether the two differ by so much that the page says why, and theory has the longer one.
bool is_shorter_than_theory(const StableStep& measured, const StepTheory& theory);

}  // namespace mssim
