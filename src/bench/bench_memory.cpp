#include "bench/bench_memory.h"

#include <algorithm>

#include "backends/reference.h"
#include "garment/bench/garment_verification.h"

namespace mssim {
namespace {

constexpr double state_node = 2 * sizeof(Vec3d);

/// The states that a run of the reference holds: ten steps ago, now, and the last before contact, which it
/// leaves.
constexpr double reference_states = 3;
/// What a garment's reference leaves: the states where stretches start and end, and their errors.
constexpr double garment_reference_node = 4 * stretches * state_node + 2 * stretches * sizeof(double);

}  // namespace

std::size_t references_at_once(const BenchSettings& settings) {
  return std::min(settings.integrators.size(), static_cast<std::size_t>(settings.execution.threads));
}

std::uint64_t bench_memory_needed(const BenchSettings& settings, const SceneSize& size) {
  const auto nodes = static_cast<double>(size.nodes);
  const double system =
      nodes * (state_node + sizeof(double)) + static_cast<double>(size.springs) * sizeof(Spring);
  double running = 0, serial = 0, held = system + state_node * nodes;  // a round's start
  for (const Integrator* integrator : settings.integrators) {
    const MemoryUse reference = reference_memory(*integrator, size.grid);
    running = std::max(running, reference.bytes(*integrator, size.nodes, size.springs, 1) +
                                    reference_states * state_node * nodes +
                                    (size.garment ? garment_reference_node * nodes : 0));
    held += (size.garment ? garment_reference_node : state_node) * nodes;
    for (const BackendInfo* backend : settings.backends) {
      const double bytes = memory_of(*backend, *integrator, size.grid)
                               .bytes(*integrator, size.nodes, size.springs, settings.execution.threads);
      held += bytes;
      if (backend->name == "serial") serial += bytes;  // verified while the references run
    }
  }
  return static_cast<std::uint64_t>(
      std::max(system + serial + static_cast<double>(references_at_once(settings)) * running,
               held + state_node * nodes));
}

}  // namespace mssim
