#include "bench/estimates.h"

#include <algorithm>
#include <cmath>

#include "backends/backends.h"
#include "bench/job/job.h"
#include "bench/verification/verification.h"
#include "garment/bench/garment_bench.h"
#include "garment/stepping/dressing_backend.h"

namespace mssim {
namespace {

constexpr double state_node = 2 * sizeof(Vec3d);

/// States that a run of the reference holds: ten steps ago, now, and the last before contact, which is its
/// result.
constexpr double reference_states = 3;
/// States that a garment's reference leaves: start and end of each stretch, and their errors.
constexpr double garment_reference_node = 4 * stretches * state_node + 2 * stretches * sizeof(double);

// Seconds, measured on two cores of a server of 2024.
constexpr double spring_s = 7e-9;      // force of one spring in the plain list
constexpr double other_methods = 0.3;  // a garment's or implicit step of other backends, relative to serial
constexpr double built_spring_s = 1.5e-7;   // building the scene
constexpr double moved_node_s = 4e-8;       // setting a state
constexpr double peaks_s = 0.5;             // for one working set, with one thread and with all
constexpr double samples_to_calibrate = 3;  // trials of growing length, then until the backend is warm
constexpr double checked_step = 3.5;    // a sample's step in the check, at most, relative to the reference's
constexpr double garment_step = 1.7;    // a garment's step of the plain list, relative to a cloth's
constexpr double verified_garment = 4;  // a garment's verification step, relative to a cloth's

/// Steps until a garment has settled: more for a finer cloth.
double dressing_steps(double nodes) { return 40 * std::sqrt(nodes); }

/// Seconds per step of the plain list.
double list_step_time(const Integrator& integrator, const SceneSize& size) {
  return spring_s * static_cast<double>(size.springs) * expected_evaluations(integrator) *
         (size.garment ? garment_step : 1);
}

/// Seconds per step of the backend.
double step_time(const BackendInfo& backend, const Integrator& integrator, const SceneSize& size) {
  const double list = list_step_time(integrator, size);
  const bool is_plain = backend.role == BackendRole::baseline || backend.program != nullptr ||
                        (backend.role == BackendRole::as_published && dresses(backend));
  if (size.garment || is_implicit(integrator)) return is_plain ? list : other_methods * list;
  return backend.step_share * list;
}

}  // namespace

std::size_t references_at_once(const BenchSettings& settings) {
  return std::min(settings.integrators.size(), static_cast<std::size_t>(settings.execution.threads));
}

std::uint64_t bench_memory_needed(const BenchSettings& settings, const SceneSize& size) {
  const auto nodes = static_cast<double>(size.nodes);
  const double system =
      nodes * (state_node + sizeof(double)) + static_cast<double>(size.springs) * sizeof(Spring);
  double running = 0, serial = 0, held = system + state_node * nodes;  // including the start state of a round
  for (const Integrator* integrator : settings.integrators) {
    const MemoryUse reference = reference_memory(*integrator, size.grid);
    running = std::max(running, reference.bytes(*integrator, size.nodes, size.springs, 1) +
                                    reference_states * state_node * nodes +
                                    (size.garment ? garment_reference_node * nodes : 0));
    held += (size.garment ? garment_reference_node : state_node) * nodes;
    for (const BackendInfo* backend : settings.backends) {
      const double bytes = memory_of(*backend, *integrator, size.grid)
                               .bytes(*integrator, size.nodes, size.springs,
                                      execution_of(*backend, settings.execution).threads);
      held += bytes;
      if (backend->each_body) held += system;                       // a system of its own for each body
      if (backend->role == BackendRole::baseline) serial += bytes;  // steps while the references run
    }
  }
  return static_cast<std::uint64_t>(
      std::max(system + serial + static_cast<double>(references_at_once(settings)) * running,
               held + state_node * nodes));
}

double expected_evaluations(const Integrator& integrator) {
  switch (integrator.solver) {
    case Solver::none:
      return static_cast<double>(integrator.stage_count);
    case Solver::newton_step:
      return 25;
    case Solver::newton:
      return 100;
    case Solver::local_global:
      return 40;
    case Solver::constraints:
      return 20;
  }
  return 0;
}

int checkable_steps(const Integrator& integrator, const SceneSize& size) {
  constexpr double patience_s = 5;
  return static_cast<int>(std::clamp<double>(patience_s / (checked_step * list_step_time(integrator, size)),
                                             verification_steps, max_sample_steps));
}

ExpectedTime total(std::span<const ExpectedTime> scenes) {
  ExpectedTime sum;
  for (const ExpectedTime& scene : scenes) {
    sum.preparation += scene.preparation;
    sum.round += scene.round;
    sum.check += scene.check;
  }
  return sum;
}

double rounds_within(double seconds, const ExpectedTime& time) {
  return std::max(1.0, (seconds - time.with(0)) / time.round);
}

ExpectedTime expected_time(const BenchSettings& settings, const SceneSize& size) {
  const auto nodes = static_cast<double>(size.nodes), springs = static_cast<double>(size.springs);
  ExpectedTime time;
  time.preparation = springs * built_spring_s;
  for (const Integrator* integrator : settings.integrators) {
    if (size.garment && !dresses(*integrator)) continue;
    const double list_step = list_step_time(*integrator, size);
    const double verification =
        settings.verified ? 0 : verification_steps * (size.garment ? verified_garment : 1);
    time.preparation += verification * list_step + (size.garment || settings.verified ? 0 : peaks_s);
    if (size.garment) time.preparation += dressing_steps(nodes) * list_step * other_methods;
    const int checkable = checkable_steps(*integrator, size);
    double checked = 0;  // steps of the longest sample
    for (const BackendInfo* backend : settings.backends) {
      const double step = step_time(*backend, *integrator, size);
      const double sample = std::max(settings.sample_seconds, step) + 2 * nodes * moved_node_s;
      time.preparation += verification * step + samples_to_calibrate * sample;
      if (size.garment && !settings.verified) time.preparation += dressing_steps(nodes) * step;
      time.round += sample;
      if (size.frame_steps <= (size.garment ? max_sample_steps : checkable))
        time.check += timed_frames * size.frame_steps * step;
      if (!size.garment && !settings.verified)
        checked = std::max(checked, std::min<double>(settings.sample_seconds / step, checkable));
    }
    time.check += checked_step * checked * list_step;
  }
  return time;
}

double expected_run_time(const BackendInfo& backend, const Integrator& integrator, const SceneSize& size,
                         double steps) {
  const double taken =
      size.garment ? std::min(steps, dressing_steps(static_cast<double>(size.nodes))) : steps;
  return static_cast<double>(size.springs) * built_spring_s + taken * step_time(backend, integrator, size);
}

}  // namespace mssim
