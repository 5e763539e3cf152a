#include "backends/openmp/openmp.h"

#include <stdexcept>
#include <string>

#include "backends/layouts/band_grid.h"
#include "backends/openmp/bodies.h"
#include "integrators/integrators.h"

namespace mssim {
namespace {

/// The kernel for an instruction set.
template <class Kernel>
Kernel kernel_for(const std::vector<Kernel>& kernels, std::string_view instruction_set) {
  for (const Kernel& kernel : kernels)
    if (kernel.instruction_set == instruction_set) return kernel;
  throw std::invalid_argument("openmp has no vector code for " + std::string(instruction_set) +
                              " that this processor can run");
}

}  // namespace

std::vector<StepKernel<BandGrid>> band_kernels(const Integrator& integrator) {
  return kernels_of_stages(integrator, [](auto stages) { return band_kernels(stages); });
}
std::vector<StepKernel<SlicedBodies>> slice_kernels(const Integrator& integrator) {
  return kernels_of_stages(integrator, [](auto stages) { return slice_kernels(stages); });
}
std::vector<StepKernel<BodyLanes>> body_lanes_kernels(const Integrator& integrator) {
  return kernels_of_stages(integrator, [](auto stages) { return body_lanes_kernels(stages); });
}

// They are the same for all integrators, and for cloths and bodies.
std::vector<std::string_view> openmp_instruction_sets() {
  std::vector<std::string_view> names;
  for (const auto& kernel : slice_kernels(integrators.front())) names.emplace_back(kernel.instruction_set);
  return names;
}

bool has_exact_roots(std::string_view instruction_set) {
  return kernel_for(slice_kernels(integrators.front()), instruction_set).exact_roots;
}

std::unique_ptr<Backend> make_openmp(const System& system, const Integrator& integrator, double dt_s,
                                     const ExecutionOptions& options) {
  return make_openmp(system, integrator, dt_s, options,
                     best_kernel(slice_kernels(integrator), options.roots).instruction_set);
}

std::unique_ptr<Backend> make_openmp(const System& system, const Integrator& integrator, double dt_s,
                                     const ExecutionOptions& options, std::string_view instruction_set) {
  const auto threads = static_cast<std::size_t>(options.threads);
  if (const auto* grid = std::get_if<GridPatch>(&system.topology)) {
    const StepKernel<BandGrid> kernel = kernel_for(band_kernels(integrator), instruction_set);
    return std::make_unique<VectorBackend<BandGrid>>(kernel, system, *grid, integrator, dt_s, kernel.lanes,
                                                     threads);
  }
  const StepKernel<BodyLanes> abreast = kernel_for(body_lanes_kernels(integrator), instruction_set);
  // A vector of springs takes a third of the time of two entries of slices, which compute each spring twice
  // but leave no lane empty.
  constexpr double lanes_per_body = 3;
  if (const auto alike = alike_bodies_for(system, abreast.lanes, lanes_per_body))
    return std::make_unique<VectorBackend<BodyLanes>>(abreast, system, *alike, integrator, dt_s,
                                                      abreast.lanes, threads);
  const StepKernel<SlicedBodies> kernel = kernel_for(slice_kernels(integrator), instruction_set);
  return std::make_unique<VectorBackend<SlicedBodies>>(kernel, system, integrator, dt_s, kernel.lanes,
                                                       threads);
}

}  // namespace mssim
