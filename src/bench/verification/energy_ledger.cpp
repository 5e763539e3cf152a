#include "bench/verification/energy_ledger.h"

#include <algorithm>

#include "backends/backends.h"
#include "laws/host_laws.h"

namespace mssim {

EnergyLedger::EnergyLedger(const System& system, const Integrator& integrator, double dt_s)
    : system_(system),
      floorless_(without_floor(system)),
      dt_s_(dt_s),
      ahead_s_(integrator.ahead * dt_s),
      reference_(make_reference(floorless_, integrator, dt_s)),
      pinned_(system.nodes(), 0),
      touches_(system.nodes(), 0) {
  for (const std::uint32_t node : system.pins) pinned_[node] = 1;
}

void EnergyLedger::step(Backend& backend) {
  const State before = backend.state();
  State start = before;
  bool was_put_on_floor = false;  // by move_back(), from where the step starts
  for (std::size_t i = 0; ahead_s_ != 0 && i < system_.nodes(); ++i) {
    if (pinned_[i] != 0 || start.position[i].y != system_.floor.height || !(start.velocity[i].y > 0))
      continue;
    start.position[i].y -= ahead_s_ * start.velocity[i].y;
    was_put_on_floor = true;
  }
  reference_->set_state(start);
  reference_->step(1);
  const State landing = reference_->state();
  const double damping = dt_s_ / 2 * (damping_power(system_, before) + damping_power(system_, landing));
  losses_.damping += damping;
  double& rest = account_for_contact(landing) || was_put_on_floor ? losses_.bounce : losses_.integration;
  rest += energy_of(system_, before).total() - energy_of(system_, landing).total() - damping;
  backend.step(1);
}

bool EnergyLedger::account_for_contact(const State& landing) {
  const Floor& floor = system_.floor;
  State after = landing;
  bool contact = false;
  for (std::size_t i = 0; i < system_.nodes(); ++i) {
    Vec3d &x = after.position[i], &v = after.velocity[i];
    x += ahead_s_ * v;  // the position that the stages see
    touches_[i] = pinned_[i] == 0 && x.y < floor.height;
    if (touches_[i] == 0) continue;
    contact = true;
    const Vec3d falling = v;
    touch_floor(x, v, floor.height, floor.restitution, floor.friction);
    x.y = std::max(x.y - ahead_s_ * v.y, floor.height);  // as move_back() does
    x.x -= ahead_s_ * v.x;
    x.z -= ahead_s_ * v.z;
    const double mass = system_.node_mass[i], rise = x.y - landing.position[i].y;
    losses_.friction += mass / 2 * (falling.x * falling.x + falling.z * falling.z - v.x * v.x - v.z * v.z);
    losses_.bounce += mass / 2 * (falling.y * falling.y - v.y * v.y) - mass * system_.gravity * rise;
  }
  if (!contact) return false;
  for (std::size_t i = 0; ahead_s_ != 0 && i < system_.nodes(); ++i)
    if (touches_[i] == 0) after.position[i] = landing.position[i];
  for (const Spring& spring : system_.springs)
    if (touches_[spring.first] != 0 || touches_[spring.second] != 0)
      losses_.bounce += elastic_energy(system_, spring, landing) - elastic_energy(system_, spring, after);
  return true;
}

}  // namespace mssim
