#include "backends/accumulation/gather_vectors.h"

#include "backends/vectors/step_kernels.h"

namespace mssim {

PaddedRows::PaddedRows(const System& system, const GridPatch& grid, const Integrator& method, double dt_s,
                       std::size_t lanes, std::size_t thread_count)
    : SeparateSteps<float>(system, method, dt_s),
      layout(grid, lanes),
      springs(springs_per_mass(system, grid)),
      threads(thread_count) {
  make_pairs(layout.floats());
  first_pin.assign(1, 0);
  for (const std::uint32_t node : system.pins) {
    const std::size_t row = node / layout.columns;
    first_pin.resize(row + 1, pins.size());
    const Vec3<float> position = vec3_cast<float>(system.start.position[node]);
    pins.push_back({layout.offset(node), {position.x, position.y, position.z}});
  }
  first_pin.resize(layout.rows + 1, pins.size());
}

void PaddedRows::set_state(const State& state) {
  float* const x = base[index(Pair::state)];
  write_fields(layout, state, x, x + 3 * layout.pitch);
}

State PaddedRows::state() const {
  const float* const x = base[index(Pair::state)];
  return read_fields(layout, layout.rows * layout.columns, x, x + 3 * layout.pitch);
}

std::unique_ptr<Backend> make_gather_vectors(const System& system, const Integrator& integrator, double dt_s,
                                             const ExecutionOptions& options) {
  const StepKernel<PaddedRows> kernel =
      best_kernel(step_kernels<PaddedRows>(integrator), options.roots, options.instruction_set);
  const auto* grid = std::get_if<GridPatch>(&system.topology);
  if (grid == nullptr)
    throw Unsupported("gather-vectors steps cloths; on bodies openmp gathers with vectors");
  return std::make_unique<VectorBackend<PaddedRows>>(kernel, system, *grid, integrator, dt_s, kernel.lanes,
                                                     static_cast<std::size_t>(options.threads));
}

}  // namespace mssim
