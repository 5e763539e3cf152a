#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "backends/interface/backend.h"
#include "model/system.h"

namespace mssim {

/// Accounts for the energy lost to damping, friction and bounces, so that kinetic + elastic + gravitational
/// energy + losses stays constant.
///
/// The losses of a step follow from the laws and from the state in which the backend starts the step, never
/// from the backend's result. A double-precision reference of the same integrator takes the same step with
/// the floor out of reach; then the floor's law is applied to the nodes that have fallen below it. The losses
/// are:
///   damping      the trapezoidal rule over damping_power before and after the reference's step,
///   friction     the kinetic energy of sliding that the floor's law removes,
///   bounce       in a step in which a node meets the floor, the rest of the step's loss: the kinetic energy
///                of falling that the law removes, less the energy of lifting nodes onto the floor,
///   integration  in all other steps, the rest of the loss: the integrator's error.
/// The integrator's error cannot be separated from the floor's loss while a node touches the floor. The floor
/// holds a node by putting it back after it has fallen through for a step; with semi-implicit Euler, both are
/// of the same order and opposite signs. The floor meets the positions that the stages see, which are ahead
/// of the state's with some integrators (step_ahead); what move_back() puts on the floor counts as bounce. A
/// backend with a wrong force, floor or integrator violates the balance. A correct backend in single
/// precision keeps it over ten to twenty thousand steps, relative to the largest change of the kinetic
/// energy: to 1e-4 with semi-implicit Euler, for cloths and for bodies, and to about 1e-3 with rk4, on a
/// floor at height 0. It cannot keep it on a floor so high that the steps of nodes at rest on it are of the
/// size of a rounding: there the balance only shows roundings.
///
/// `integration` includes the error of the trapezoidal rule. In a second with bounces, relative to the
/// kinetic energy of the fall, the small bodies of the paper lose or gain 0.001 by it with semi-implicit
/// Euler, gain 0.002 to 0.05 with midpoint and rk4, and 0.08 to 0.5 with the frozen methods, which take
/// damping and stiffness from the start of the step.
class EnergyLedger {
 public:
  /// `system` and `integrator` must outlive the ledger; `dt_s` is the step of the backends that it follows.
  EnergyLedger(const System& system, const Integrator& integrator, double dt_s);

  /// Steps the backend once and accounts for its losses. The backend must have the ledger's system,
  /// integrator and dt.
  void step(Backend& backend);
  /// Losses since the ledger was made, J.
  const EnergyLosses& losses() const { return losses_; }

 private:
  /// Returns whether any node meets the floor.
  bool account_for_contact(const State& landing);

  const System& system_;
  System floorless_;  // `system_` with the floor out of reach
  double dt_s_;
  double ahead_s_;                      // of the positions that the stages see (Integrator::ahead)
  std::unique_ptr<Backend> reference_;  // of floorless_
  std::vector<std::uint8_t> pinned_;    // [nodes]
  std::vector<std::uint8_t> touches_;   // [nodes] whether the current step ends on the floor
  EnergyLosses losses_;
};

}  // namespace mssim
