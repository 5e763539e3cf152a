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
  return best_kernel(step_kernels<SlicedBodies>(integrators.front()), Roots::fast, instruction_set)
      .exact_roots;
}

namespace {

/// The narrowest kernel that needs no more vectors for the springs of these bodies than `best`, rounds as
/// often, and has `roots`: seven bodies leave nine of 16 lanes empty. On two Zen 4 cores, bodies20587, AVX2
/// instead of AVX-512: 0.75 of the time with one thread and 0.57 to 0.70 with two, although AVX2's code uses
/// roots and divisions.
template <class Real>
StepKernel<BodyLanesOf<Real>> narrowest_kernel(const std::vector<StepKernel<BodyLanesOf<Real>>>& kernels,
                                               const StepKernel<BodyLanesOf<Real>>& best,
                                               const std::vector<AlikeBodiesOf<Real>>& bodies, Roots roots) {
  StepKernel<BodyLanesOf<Real>> narrowest = best;
  for (const StepKernel<BodyLanesOf<Real>>& kernel : kernels)
    if (kernel.lanes < narrowest.lanes && kernel.fuses == best.fuses &&
        (roots == Roots::fast || kernel.exact_roots) &&
        spring_vectors(bodies, kernel.lanes) <= spring_vectors(bodies, best.lanes))
      narrowest = kernel;
  return narrowest;
}

template <class Real>
std::unique_ptr<Backend> openmp_of(const System& system, const Integrator& integrator, double dt_s,
                                   const ExecutionOptions& options) {
  using Bands = BandGridOf<Real>;
  using Slices = SlicedBodiesOf<Real>;
  using Abreast = BodyLanesOf<Real>;
  const auto best = [&](const auto& kernels) {
    return best_kernel(kernels, options.roots, options.instruction_set);
  };
  const auto threads = static_cast<std::size_t>(options.threads);
  if (const auto* grid = std::get_if<GridPatch>(&system.topology)) {
    const StepKernel<Bands> kernel = best(step_kernels<Bands>(integrator));
    return std::make_unique<VectorBackend<Bands>>(kernel, system, *grid, integrator, dt_s, kernel.lanes,
                                                  threads);
  }
  const std::vector<StepKernel<Abreast>> kernels = step_kernels<Abreast>(integrator);
  StepKernel<Abreast> abreast = best(kernels);
  // A vector of springs takes a third of the time of two entries of slices, which compute each spring twice
  // but leave no lane empty.
  constexpr double lanes_per_body = 3;
  if (const auto alike = alike_bodies_for<Real>(system, abreast.lanes, lanes_per_body)) {
    if (options.instruction_set.empty()) abreast = narrowest_kernel(kernels, abreast, *alike, options.roots);
    return std::make_unique<VectorBackend<Abreast>>(abreast, system, *alike, integrator, dt_s, abreast.lanes,
                                                    threads);
  }
  const StepKernel<Slices> kernel = best(step_kernels<Slices>(integrator));
  return std::make_unique<VectorBackend<Slices>>(kernel, system, integrator, dt_s, kernel.lanes, threads);
}

}  // namespace

std::unique_ptr<Backend> make_openmp(const System& system, const Integrator& integrator, double dt_s,
                                     const ExecutionOptions& options) {
  return openmp_of<float>(system, integrator, dt_s, options);
}

std::unique_ptr<Backend> make_openmp_in_double(const System& system, const Integrator& integrator,
                                               double dt_s, const ExecutionOptions& options) {
  return openmp_of<double>(system, integrator, dt_s, options);
}

}  // namespace mssim
