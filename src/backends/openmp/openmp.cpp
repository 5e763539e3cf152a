#include "backends/openmp/openmp.h"

#include <stdexcept>
#include <string>
#include <utility>

#include "backends/layouts/band_grid.h"
#include "backends/openmp/body_lanes.h"
#include "backends/openmp/sliced_bodies.h"
#include "backends/openmp/step_bands.h"
#include "backends/openmp/step_body_lanes.h"
#include "backends/openmp/step_slices.h"
#include "integrators/integrators.h"

namespace mssim {
namespace {

/// A cloth in bands.
class OpenMpGrid final : public Backend {
 public:
  OpenMpGrid(const System& system, const GridPatch& grid, const Integrator& integrator, double dt_s,
             std::size_t threads, const BandKernel& kernel)
      : kernel_(kernel), bands_(system, grid, integrator, dt_s, kernel_.lanes, threads) {
    bands_.set_state(system.start);
  }

  void set_state(const State& state) override { bands_.set_state(state); }
  State state() const override { return bands_.state(); }
  void step(int count) override { kernel_.step(bands_, count); }
  std::string device() const override { return std::string("cpu ") + kernel_.instruction_set; }
  int threads() const override { return static_cast<int>(bands_.partitions.size()); }
  int steps_per_pass() const override { return static_cast<int>(bands_.steps_per_pass); }

 private:
  BandKernel kernel_;
  BandGrid bands_;
};

/// Bodies in slices, or alike ones beside each other.
template <class Bodies, class Kernel>
class OpenMpBodies final : public Backend {
 public:
  OpenMpBodies(const System& system, const Kernel& kernel, Bodies bodies)
      : kernel_(kernel), bodies_(std::move(bodies)) {
    bodies_.set_state(system.start);
  }

  void set_state(const State& state) override { bodies_.set_state(state); }
  State state() const override { return bodies_.state(); }
  void step(int count) override { kernel_.step(bodies_, count); }
  std::string device() const override { return std::string("cpu ") + kernel_.instruction_set; }
  int threads() const override { return static_cast<int>(bodies_.threads); }
  std::optional<std::uint64_t> stored_springs() const override {
    if constexpr (requires { bodies_.stored_springs(); }) return bodies_.stored_springs();
    return std::nullopt;
  }

 private:
  Kernel kernel_;
  Bodies bodies_;
};

/// The kernel for an instruction set.
template <class Kernel>
Kernel kernel_for(const std::vector<Kernel>& kernels, std::string_view instruction_set) {
  for (const Kernel& kernel : kernels)
    if (kernel.instruction_set == instruction_set) return kernel;
  throw std::invalid_argument("openmp has no vector code for " + std::string(instruction_set) +
                              " that this processor can run");
}

}  // namespace

// They are the same for all integrators, and for cloths and bodies.
std::vector<std::string_view> openmp_instruction_sets() {
  std::vector<std::string_view> names;
  for (const SliceKernel& kernel : slice_kernels(integrators.front()))
    names.emplace_back(kernel.instruction_set);
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
  if (const auto* grid = std::get_if<GridPatch>(&system.topology))
    return std::make_unique<OpenMpGrid>(system, *grid, integrator, dt_s, threads,
                                        kernel_for(band_kernels(integrator), instruction_set));
  const BodyLanesKernel abreast = kernel_for(body_lanes_kernels(), instruction_set);
  // A vector of springs takes a third of the time of two entries of slices, which compute each spring twice
  // but leave no lane empty.
  constexpr double lanes_per_body = 3;
  if (const auto alike = alike_bodies_for(system, abreast.lanes, lanes_per_body))
    return std::make_unique<OpenMpBodies<BodyLanes, BodyLanesKernel>>(
        system, abreast, BodyLanes(system, *alike, integrator, dt_s, abreast.lanes, threads));
  const SliceKernel kernel = kernel_for(slice_kernels(integrator), instruction_set);
  return std::make_unique<OpenMpBodies<SlicedBodies, SliceKernel>>(
      system, kernel, SlicedBodies(system, integrator, dt_s, kernel.lanes, threads));
}

}  // namespace mssim
