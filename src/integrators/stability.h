#pragma once

#include <functional>
#include <vector>

#include "integrators/integrator.h"

namespace mssim {

/// Model of a system's modes for its stability limit: oscillators x'' = -k x - c(k) x' for every k up to
/// `stiffness`. The damping c grows linearly with k, from `viscous_damping` for a mode that stretches no
/// spring to `damping` for the stiffest, because springs damp what they resist. If springs damp in different
/// proportions to their stiffness (`parts`), a mode has the least damping if it stretches those that damp
/// least as far as these reach, and then the next ones; and the most in the opposite order. Both are modes of
/// the model.
struct ModeBound {
  /// Springs that damp in one proportion to their stiffness.
  struct Part {
    double stiffness = 0;  ///< 1/s^2, at least the largest eigenvalue of their part of K/m
    double damping = 0;    ///< 1/s, at least the largest eigenvalue of their part of C/m
  };
  double stiffness = 0;          ///< 1/s^2, at least the largest eigenvalue of K/m
  double damping = 0;            ///< 1/s, at least the largest eigenvalue of C/m, viscous damping included
  double viscous_damping = 0;    ///< 1/s, its part that acts on every mode
  std::vector<Part> parts = {};  ///< empty: all damp in the same proportion
};

/// Growth per step that still counts as stable. Zero would exclude the midpoint rule for every undamped mode,
/// at every dt, because it multiplies an oscillation by 1 + (omega dt)^4 / 8. At this rate an error doubles
/// in 700 000 steps, more than a scene runs for.
inline constexpr double tolerated_growth = 1e-6;

/// Largest factor by which a step of dt_s multiplies a mode of the given stiffness (1/s^2) and damping (1/s):
/// the spectral radius of the integrator's step matrix for the oscillator. `integrator` must be explicit.
double amplification(const Integrator& integrator, double dt_s, double stiffness, double damping);

/// The largest amplification over the modes of the bound: the factor per step of an error once the
/// fastest-growing mode dominates it.
double largest_amplification(const Integrator& integrator, double dt_s, const ModeBound& bound);

/// The dt in s below which no mode of the bound grows by more than tolerated_growth per step; infinite for
/// implicit integrators and if neither stiffness nor damping bounds it, 0 if every dt is unstable.
double largest_stable_dt(const Integrator& integrator, const ModeBound& bound);

/// Longest time step that a scene file may have, s.
inline constexpr double longest_dt_s = 1;

/// The dt in s of scenes with "auto": half of the smallest limit over the methods of Hong et al., so all can
/// be compared at one dt. The rows that only repeat a method's published cost with a frozen acceleration
/// (`-frozen`) and explicit Euler are excluded: with little damping, no useful dt keeps them from growing.
/// Half, because the limit is valid for small motions about the rest shape: a strained spring also resists
/// sideways, without damping. Half the dt leaves room for four times the stiffness; the floor's impulses are
/// not modes at all. `steps`: whether the scene can be stepped with a method; others are left out. At
/// most longest_dt_s. Throws std::invalid_argument if nothing bounds dt.
double auto_dt(const ModeBound& bound, const std::function<bool(const Integrator& integrator)>& steps = {});

}  // namespace mssim
