#include "backends/openmp/openmp.h"

#include "backends/layouts/band_grid.h"
#include "backends/openmp/bodies.h"
#include "backends/vectors/step_kernels.h"
#include "integrators/all_integrators.h"

namespace mssim {

// Identical for all integrators, and for cloths and bodies.
std::vector<std::string_view> openmp_instruction_sets() {
  return instruction_sets_of(step_kernels<SlicedBodies>(integrators.front()));
}

bool has_exact_roots(std::string_view instruction_set) {
  return kernel_named(step_kernels<SlicedBodies>(integrators.front()), instruction_set).exact_roots;
}

namespace {

/// The narrowest kernel that needs no more vectors for the springs of these bodies than `best`, rounds as
/// often, and has `roots`: seven bodies leave nine of 16 lanes empty. On two Zen 4 cores, bodies20587, AVX2
/// instead of AVX-512: 0.75 of the time with one thread and 0.57 to 0.70 with two, although AVX2's code uses
/// roots and divisions.
StepKernel<BodyLanes> narrowest_kernel(const std::vector<StepKernel<BodyLanes>>& kernels,
                                       const StepKernel<BodyLanes>& best,
                                       const std::vector<AlikeBodies>& bodies, Roots roots) {
  StepKernel<BodyLanes> narrowest = best;
  for (const StepKernel<BodyLanes>& kernel : kernels)
    if (kernel.lanes < narrowest.lanes && kernel.fuses == best.fuses &&
        (roots == Roots::fast || kernel.exact_roots) &&
        spring_vectors(bodies, kernel.lanes) <= spring_vectors(bodies, best.lanes))
      narrowest = kernel;
  return narrowest;
}

/// `roots`: empty to use only this instruction set.
std::unique_ptr<Backend> make_openmp(const System& system, const Integrator& integrator, double dt_s,
                                     std::size_t threads, std::string_view instruction_set,
                                     std::optional<Roots> roots) {
  if (const auto* grid = std::get_if<GridPatch>(&system.topology)) {
    const StepKernel<BandGrid> kernel = kernel_named(step_kernels<BandGrid>(integrator), instruction_set);
    return std::make_unique<VectorBackend<BandGrid>>(kernel, system, *grid, integrator, dt_s, kernel.lanes,
                                                     threads);
  }
  const std::vector<StepKernel<BodyLanes>> kernels = step_kernels<BodyLanes>(integrator);
  StepKernel<BodyLanes> abreast = kernel_named(kernels, instruction_set);
  // A vector of springs takes a third of the time of two entries of slices, which compute each spring twice
  // but leave no lane empty.
  constexpr double lanes_per_body = 3;
  if (const auto alike = alike_bodies_for(system, abreast.lanes, lanes_per_body)) {
    if (roots) abreast = narrowest_kernel(kernels, abreast, *alike, *roots);
    return std::make_unique<VectorBackend<BodyLanes>>(abreast, system, *alike, integrator, dt_s,
                                                      abreast.lanes, threads);
  }
  const StepKernel<SlicedBodies> kernel =
      kernel_named(step_kernels<SlicedBodies>(integrator), instruction_set);
  return std::make_unique<VectorBackend<SlicedBodies>>(kernel, system, integrator, dt_s, kernel.lanes,
                                                       threads);
}

}  // namespace

std::unique_ptr<Backend> make_openmp(const System& system, const Integrator& integrator, double dt_s,
                                     const ExecutionOptions& options) {
  const auto best =
      best_kernel(step_kernels<SlicedBodies>(integrator), options.roots, options.instruction_set);
  return make_openmp(system, integrator, dt_s, static_cast<std::size_t>(options.threads),
                     best.instruction_set,
                     options.instruction_set.empty() ? std::optional(options.roots) : std::nullopt);
}

std::unique_ptr<Backend> make_openmp(const System& system, const Integrator& integrator, double dt_s,
                                     const ExecutionOptions& options, std::string_view instruction_set) {
  return make_openmp(system, integrator, dt_s, static_cast<std::size_t>(options.threads), instruction_set,
                     std::nullopt);
}

}  // namespace mssim
