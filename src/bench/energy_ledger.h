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
/// A backend with another force or floor, or with another integrator, makes the balance fail; one in single
/// precision that is right keeps it to some 1e-6 of the energy in motion over ten thousand steps on a floor
/// at height 0, and to some 1e-4 on one whose height is not exact in single precision.
///
/// The error of the trapezoidal rule stands under `integration`, too: with the second- and fourth-order
/// methods the two come to some 1e-4 of the energy in motion at usual steps. Semi-implicit Euler's error, of
/// first order, is a few per cent and grows while a body lies on the floor; the frozen methods feed in about
/// as much.
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
