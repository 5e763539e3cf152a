#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "backends/backend.h"
#include "model/energy.h"

namespace mssim {

/// Accounts for what damping, friction and bounces take, so that kinetic + elastic + gravitational energy +
/// losses stays constant.
///
/// The losses of a step follow from the laws and from the state that the backend starts it with, never from
/// the backend's result. A double-precision reference of the same integrator takes the same step with the
/// floor out of reach; then the floor's law is applied to the nodes that have fallen below it. So
///   damping      the trapezoidal rule over damping_power before and after the reference's step,
///   integration  what else the total energy loses in the reference's step: the integrator's error,
///   friction     the kinetic energy of sliding that the floor's law takes,
///   bounce       that of falling, less the gravitational and with the elastic energy that lifting the nodes
///                onto the floor changes.
/// A backend with another force or floor, or with another integrator, makes the balance fail. One in single
/// precision that is right keeps it, in shares of the largest change of the kinetic energy and over ten
/// thousand steps, to some 1e-6 for bodies on a floor at height 0, to some 1e-4 for cloths, and to some 1e-3
/// on a floor so high that the steps of nodes at rest on it are of the size of a rounding.
///
/// `integration` has the error of the trapezoidal rule in it, too. With the second- and fourth-order methods
/// both come to less than 1e-3 for bodies at usual steps, so that there the other three losses balance by
/// themselves. Semi-implicit Euler's error, of first order, is some per cent and grows while a body lies on
/// the floor, since each contact breaks the shadow energy that the method conserves; the frozen methods,
/// which take damping and stiffness from the start of the step, feed in as much or more.
class EnergyLedger {
 public:
  /// `system` and `integrator` must outlive the ledger; `dt_s` is the step of the backends that it follows.
  EnergyLedger(const System& system, const Integrator& integrator, double dt_s);

  /// Lets the backend, one of the ledger's system, integrator and dt, take a step, and accounts for it.
  void step(Backend& backend);
  /// Since the ledger was made.
  const EnergyLosses& losses() const { return losses_; }

 private:
  void account_for_contact(const State& landing);

  const System& system_;
  System floorless_;  // the same with the floor out of reach
  double dt_s_;
  std::unique_ptr<Backend> reference_;  // of floorless_
  std::vector<std::uint8_t> pinned_;    // [nodes]
  std::vector<std::uint8_t> touches_;   // [nodes] does the step under way end on the floor?
  EnergyLosses losses_;
};

}  // namespace mssim
