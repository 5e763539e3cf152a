#include "backends/openmp/openmp.h"

#include "backends/layouts/band_grid.h"
#include "backends/openmp/bodies.h"
#include "backends/vectors/step_kernels.h"
#include "integrators/all_integrators.h"

namespace mssim {

// They are the same for all integrators, and for cloths and bodies.
std::vector<std::string_view> openmp_instruction_sets() {
  return instruction_sets_of(step_kernels<SlicedBodies>(integrators.front()));
}

bool has_exact_roots(std::string_view instruction_set) {
  return kernel_named(step_kernels<SlicedBodies>(integrators.front()), instruction_set).exact_roots;
}

std::unique_ptr<Backend> make_openmp(const System& system, const Integrator& integrator, double dt_s,
                                     const ExecutionOptions& options) {
  return make_openmp(system, integrator, dt_s, options,
                     best_kernel(step_kernels<SlicedBodies>(integrator), options.roots).instruction_set);
}

std::unique_ptr<Backend> make_openmp(const System& system, const Integrator& integrator, double dt_s,
                                     const ExecutionOptions& options, std::string_view instruction_set) {
  const auto threads = static_cast<std::size_t>(options.threads);
  if (const auto* grid = std::get_if<GridPatch>(&system.topology)) {
    const StepKernel<BandGrid> kernel = kernel_named(step_kernels<BandGrid>(integrator), instruction_set);
    return std::make_unique<VectorBackend<BandGrid>>(kernel, system, *grid, integrator, dt_s, kernel.lanes,
                                                     threads);
  }
  const StepKernel<BodyLanes> abreast = kernel_named(step_kernels<BodyLanes>(integrator), instruction_set);
  // A vector of springs takes a third of the time of two entries of slices, which compute each spring twice
  // but leave no lane empty.
  constexpr double lanes_per_body = 3;
  if (const auto alike = alike_bodies_for(system, abreast.lanes, lanes_per_body))
    return std::make_unique<VectorBackend<BodyLanes>>(abreast, system, *alike, integrator, dt_s,
                                                      abreast.lanes, threads);
  const StepKernel<SlicedBodies> kernel =
      kernel_named(step_kernels<SlicedBodies>(integrator), instruction_set);
  return std::make_unique<VectorBackend<SlicedBodies>>(kernel, system, integrator, dt_s, kernel.lanes,
                                                       threads);
}

}  // namespace mssim
