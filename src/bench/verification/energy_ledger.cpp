#include "bench/verification/energy_ledger.h"

#include <algorithm>

#include "backends/backends.h"
#include "integrators/host_stages.h"

namespace mssim {
EnergyLedger::EnergyLedger(const System& system, const Integrator& integrator, double dt_s)
    : system_(system),
      floorless_(without_floor(system)),
      dt_s_(dt_s),
      reference_(make_reference(floorless_, integrator, dt_s)),
      pinned_(system.nodes(), 0),
      touches_(system.nodes(), 0) {
  for (const std::uint32_t node : system.pins) pinned_[node] = 1;
}

void EnergyLedger::step(Backend& backend) {
  const State before = backend.state();
  reference_->set_state(before);
  reference_->step(1);
  const State landing = reference_->state();
  const double damping = dt_s_ / 2 * (damping_power(system_, before) + damping_power(system_, landing));
  losses_.damping += damping;
  double& rest = account_for_contact(landing) ? losses_.bounce : losses_.integration;
  rest += energy_of(system_, before).total() - energy_of(system_, landing).total() - damping;
  backend.step(1);
}

bool EnergyLedger::account_for_contact(const State& landing) {
  const Floor& floor = system_.floor;
  State after = landing;
  bool contact = false;
  for (std::size_t i = 0; i < system_.nodes(); ++i) {
    touches_[i] = pinned_[i] == 0 && landing.position[i].y < floor.height;
    if (touches_[i] == 0) continue;
    contact = true;
    Vec3d &x = after.position[i], &v = after.velocity[i];
    const Vec3d falling = v;
    const double depth = floor.height - x.y;
    touch_floor(x, v, floor.height, floor.restitution, floor.friction);
    const double mass = system_.node_mass[i];
    losses_.friction += mass / 2 * (falling.x * falling.x + falling.z * falling.z - v.x * v.x - v.z * v.z);
    losses_.bounce += mass / 2 * (falling.y * falling.y - v.y * v.y) - mass * system_.gravity * depth;
  }
  if (!contact) return false;
  for (const Spring& spring : system_.springs)
    if (touches_[spring.first] != 0 || touches_[spring.second] != 0)
      losses_.bounce += elastic_energy(system_, spring, landing) - elastic_energy(system_, spring, after);
  return true;
}

}  // namespace mssim
