#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "backends/interface/backend.h"
#include "model/energy.h"

namespace mssim {

/// Accounts for what damping, friction and bounces take, so that kinetic + elastic + gravitational energy +
/// losses stays constant.
///
/// The losses of a step follow from the laws and from the state that the backend starts it with, never from
/// the backend's result. A double-precision reference of the same integrator takes the same step with the
/// floor out of reach; then the floor's law is applied to the nodes that have fallen below it. So
///   damping      the trapezoidal rule over damping_power before and after the reference's step,
///   friction     the kinetic energy of sliding that the floor's law takes,
///   bounce       in a step in which a node meets the floor, what else the step loses: the kinetic energy of
///                falling that the law takes, less what lifting nodes onto the floor gives them,
///   integration  in all other steps, what else they lose: the integrator's error.
/// (An integrator's error cannot be told from the floor's taking while a node is on it: falling through the
/// floor for a step and being put back is how a floor holds a node, and for semi-implicit Euler both are of
/// the same order and of unlike signs.)
/// A backend with another force or floor, or with another integrator, makes the balance fail. One in single
/// precision that is right keeps it, in shares of the largest change of the kinetic energy and over ten to
/// twenty thousand steps, to 1e-4 for bodies on a floor at height 0 and for cloths, and to some 1e-3 on a
/// floor so high that the steps of nodes at rest on it are of the size of a rounding.
///
/// `integration` has the error of the trapezoidal rule in it, too. Of the kinetic energy of their fall, in a
/// second with bounces, the small bodies of the paper lose or gain 0.001 by it with semi-implicit Euler and
/// gain 0.002 to 0.05 with midpoint and rk4, and 0.08 to 0.5 with the frozen methods, which take damping and
/// stiffness from the start of the step.
class EnergyLedger {
 public:
  /// `system` and `integrator` must outlive the ledger; `dt_s` is the step of the backends that it follows.
  EnergyLedger(const System& system, const Integrator& integrator, double dt_s);

  /// Lets the backend, one of the ledger's system, integrator and dt, take a step, and accounts for it.
  void step(Backend& backend);
  /// Since the ledger was made.
  const EnergyLosses& losses() const { return losses_; }

 private:
  /// Returns whether any node meets the floor.
  bool account_for_contact(const State& landing);

  const System& system_;
  System floorless_;  // the same with the floor out of reach
  double dt_s_;
  std::unique_ptr<Backend> reference_;  // of floorless_
  std::vector<std::uint8_t> pinned_;    // [nodes]
  std::vector<std::uint8_t> touches_;   // [nodes] does the step under way end on the floor?
  EnergyLosses losses_;
};

}  // namespace mssim
