#include "bench/bench_memory.h"

#include <algorithm>

#include "garment/bench/garment_verification.h"

namespace mssim {
namespace {

constexpr double state_node = 2 * sizeof(Vec3d);

/// The double-precision reference: a spring list of twice the bytes, but for a byte that says what is pinned.
constexpr MemoryUse reference{.node = 2 * spring_list_memory.node - 1,
                              .pair_node = 2 * spring_list_memory.pair_node};
/// The states that a run of the reference holds: ten steps ago, now, and the last before contact.
constexpr double reference_states = 3;
/// Those of a verification: the reference's, and the one read back.
constexpr double verification_states = 2;
/// Those that a garment's reference keeps, where stretches start and end; and their errors.
constexpr double garment_states = 4 * stretches;
constexpr double garment_error_node = 2 * stretches * sizeof(double);

}  // namespace

std::uint64_t bench_memory_needed(const BenchSettings& settings, const SceneSize& size) {
  const auto nodes = static_cast<double>(size.nodes);
  double held =  // the System
      nodes * (state_node + sizeof(double)) + static_cast<double>(size.springs) * sizeof(Spring);
  if (size.garment) held += nodes * (garment_states * state_node + garment_error_node);
  double peak = held;
  for (const Integrator* integrator : settings.integrators) {
    peak = std::max(peak, held + reference.bytes(*integrator, size.nodes, size.springs, 1) +
                              reference_states * state_node * nodes);
    for (const BackendInfo* backend : settings.backends)
      held += (size.grid ? backend->grid_memory : backend->mesh_memory)
                  .bytes(*integrator, size.nodes, size.springs, settings.execution.threads);
    peak = std::max(peak, held + verification_states * state_node * nodes);
  }
  return static_cast<std::uint64_t>(peak);
}

}  // namespace mssim
