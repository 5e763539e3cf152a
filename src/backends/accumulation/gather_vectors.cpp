#include "backends/accumulation/gather_vectors.h"

namespace mssim {

PaddedRows::PaddedRows(const System& system, const GridPatch& grid, const Integrator& method, double dt_s,
                       std::size_t lanes, std::size_t thread_count)
    : layout(grid, lanes),
      integrator(&method),
      coefficients(coefficients_of<float>(method, dt_s)),
      springs(spring_constants_of(system, grid)),
      surroundings(surroundings_of(system)),
      threads(thread_count) {
  for (const Pair pair : stored_pairs(method, Storage::separate)) {
    pairs[index(pair)] = AlignedArray(layout.floats());
    base[index(pair)] = pairs[index(pair)].data();
  }
  first_pin.assign(1, 0);
  for (const std::uint32_t node : system.pins) {
    const std::size_t row = node / layout.columns;
    first_pin.resize(row + 1, pins.size());
    const Vec3<float> position = vec3_cast<float>(system.start.position[node]);
    pins.push_back({layout.offset(row, node % layout.columns), {position.x, position.y, position.z}});
  }
  first_pin.resize(layout.rows + 1, pins.size());
}

void PaddedRows::set_state(const State& state) {
  for (std::size_t node = 0; node < state.position.size(); ++node) {
    const Vec3d &x = state.position[node], &v = state.velocity[node];
    float* out = base[index(Pair::state)] + layout.offset(node / layout.columns, node % layout.columns);
    for (const double value : {x.x, x.y, x.z, v.x, v.y, v.z}) {
      *out = static_cast<float>(value);
      out += layout.pitch;
    }
  }
}

State PaddedRows::state() const {
  State state;
  state.position.reserve(layout.rows * layout.columns);
  state.velocity.reserve(layout.rows * layout.columns);
  const std::size_t step = layout.pitch;
  for (std::size_t row = 0; row < layout.rows; ++row) {
    const float* in = base[index(Pair::state)] + layout.offset(row, 0);
    for (std::size_t column = 0; column < layout.columns; ++column, ++in) {
      state.position.push_back(vec3_cast<double>(Vec3<float>{in[0], in[step], in[2 * step]}));
      state.velocity.push_back(vec3_cast<double>(Vec3<float>{in[3 * step], in[4 * step], in[5 * step]}));
    }
  }
  return state;
}

std::unique_ptr<Backend> make_gather_vectors(const System& system, const Integrator& integrator, double dt_s,
                                             const ExecutionOptions& options,
                                             const StepKernel<PaddedRows>& kernel) {
  const auto* grid = std::get_if<GridPatch>(&system.topology);
  if (grid == nullptr)
    throw Unsupported("gather-vectors steps cloths; on bodies openmp gathers with vectors");
  return std::make_unique<VectorBackend<PaddedRows>>(kernel, system, *grid, integrator, dt_s, kernel.lanes,
                                                     static_cast<std::size_t>(options.threads));
}

std::unique_ptr<Backend> make_gather_vectors(const System& system, const Integrator& integrator, double dt_s,
                                             const ExecutionOptions& options) {
  return make_gather_vectors(system, integrator, dt_s, options,
                             best_kernel(step_kernels<PaddedRows>(integrator), options.roots));
}

}  // namespace mssim
