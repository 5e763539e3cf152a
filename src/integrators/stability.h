#pragma once

#include "integrators/integrator.h"

namespace mssim {

/// What the modes of a system are taken to be, for its stability limit: oscillators x'' = -k x - c(k) x' with
/// every k up to `stiffness`. The damping c grows with k along a line, from `viscous_damping` of a mode that
/// stretches no spring to `damping` of the stiffest, because springs damp what they resist.
struct ModeBound {
  double stiffness = 0;        ///< 1/s^2, at least the largest eigenvalue of K/m
  double damping = 0;          ///< 1/s, at least the largest eigenvalue of C/m, viscous damping included
  double viscous_damping = 0;  ///< 1/s, the part of it that acts on every mode
};

/// Growth per step that still counts as stable. Zero would rule out the midpoint rule for every undamped
/// mode, at every dt, since it multiplies an oscillation by 1 + (omega dt)^4 / 8. At this rate an error
/// doubles in 700 000 steps, more than a scene is run for.
inline constexpr double tolerated_growth = 1e-6;

/// Largest factor by which a step of dt_s multiplies a mode of the given stiffness (1/s^2) and damping (1/s):
/// the spectral radius of the matrix that the integrator's stages make of the oscillator. `integrator` must
/// be explicit.
double amplification(const Integrator& integrator, double dt_s, double stiffness, double damping);

/// The largest amplification of the modes of the bound: what a step multiplies an error by, once the mode
/// that grows fastest makes up the most of it.
double largest_amplification(const Integrator& integrator, double dt_s, const ModeBound& bound);

/// The dt in s below which the integrator keeps every mode of the bound from growing by more than
/// tolerated_growth a step; infinite where neither stiffness nor damping bounds it and for implicit
/// integrators, 0 where it keeps none at any dt.
double largest_stable_dt(const Integrator& integrator, const ModeBound& bound);

/// The dt in s of scenes that say "auto": half of the smallest limit over the methods of Hong et al., so that
/// all can be compared at one dt. The rows that only repeat a method's published cost with the acceleration
/// held (`-frozen`) and explicit Euler are not asked: with little damping no useful dt keeps them from
/// growing. Half, because the limit is that of small motions about the rest shape. A strained spring also
/// resists sideways, where nothing damps it; half a dt leaves room for four times the stiffness, and the
/// floor's impulses are no modes at all. Throws std::invalid_argument when nothing bounds dt.
double auto_dt(const ModeBound& bound);

}  // namespace mssim
