#include "commands/shared/simulation.h"

#include <cmath>
#include <limits>
#include <sstream>

#include "bench/verification/energy_ledger.h"
#include "bench/verification/verification.h"
#include "text/error.h"

namespace mssim {
namespace {

/// Longest run, in steps: a frame's steps are counted in an int, and beyond 2^53 times lose whole steps.
constexpr double most_steps = std::numeric_limits<int>::max();

}  // namespace

std::int64_t count_steps(const SimulationPlan& plan) {
  const double exact_steps = plan.duration_s / plan.dt_s;
  if (!(exact_steps >= 0.5 && exact_steps <= most_steps)) {
    std::ostringstream text;
    text << "a duration of " << plan.duration_s << " s is " << exact_steps << " steps of " << plan.dt_s
         << " s; --duration must give between one step and " << most_steps;
    throw UsageError(text.str());
  }
  return static_cast<std::int64_t>(std::llround(exact_steps));
}

FrameGrid frame_grid(double frames_per_second, double dt_s) {
  const double steps_per_frame = 1 / (frames_per_second * dt_s);
  if (!(steps_per_frame >= 1)) {
    std::ostringstream text;
    text << "--fps " << frames_per_second << " is more than one frame a step of " << dt_s << " s; take --fps "
         << (dt_s > 1 ? 1 / dt_s : std::floor(1 / dt_s)) << " or less";
    throw UsageError(text.str());
  }
  return {steps_per_frame};
}

void simulate(Backend& backend, const System& system, const Integrator& integrator,
              const SimulationPlan& plan, const SimulationWatch& watch) {
  const std::int64_t steps = count_steps(plan);
  const FrameGrid grid = frame_grid(plan.frames_per_second, plan.dt_s);
  std::optional<EnergyLedger> ledger;
  if (plan.accounts_for_losses) ledger.emplace(system, integrator, plan.dt_s);
  const auto losses = [&] { return ledger ? std::optional(ledger->losses()) : std::nullopt; };
  backend.set_state(system.start);
  State before = system.start;
  watch.on_frame({0, 0, before, energy_of(system, before), losses()});
  std::int64_t done = 0;
  for (std::int64_t frame = 1; done < steps; ++frame) {
    const std::int64_t next = std::min(steps, grid.step_of(frame));
    const int count = static_cast<int>(next - done);
    if (ledger) {
      for (int step = 0; step < count; ++step) {
        watch.on_progress(done + step, steps);
        ledger->step(backend);
      }
    } else {
      watch.on_progress(done, steps);
      backend.step(count);
    }
    State state = backend.state();
    if (const auto node = first_bad_node(state)) {
      const BlowUp blow_up = find_blow_up(backend, before, count).value_or(BlowUp{count, *node});
      throw NotVerified("the simulation " + describe(blow_up, plan.dt_s, done));
    }
    done = next;
    watch.on_frame({done, static_cast<double>(done) * plan.dt_s, state, energy_of(system, state), losses()});
    before = std::move(state);
  }
}

}  // namespace mssim
