#include "backends/accumulation/gather_vectors.h"

#include <string>

namespace mssim {
namespace {

class GatherVectors final : public Backend {
 public:
  GatherVectors(const System& system, const GridPatch& grid, const Integrator& integrator, double dt_s,
                int threads, const RowKernel& kernel)
      : kernel_(kernel),
        cloth_(system, grid, integrator, dt_s, kernel_.lanes, static_cast<std::size_t>(threads)) {
    cloth_.set_state(system.start);
  }

  void set_state(const State& state) override { cloth_.set_state(state); }
  State state() const override { return cloth_.state(); }
  void step(int count) override { kernel_.step(cloth_, count); }
  std::string device() const override { return std::string("cpu ") + kernel_.instruction_set; }
  int threads() const override { return static_cast<int>(cloth_.threads); }

 private:
  RowKernel kernel_;
  PaddedRows cloth_;
};

}  // namespace

std::unique_ptr<Backend> make_gather_vectors(const System& system, const Integrator& integrator, double dt_s,
                                             const ExecutionOptions& options, const RowKernel& kernel) {
  const auto* grid = std::get_if<GridPatch>(&system.topology);
  if (grid == nullptr)
    throw Unsupported("gather-vectors steps cloths; on bodies openmp gathers with vectors");
  return std::make_unique<GatherVectors>(system, *grid, integrator, dt_s, options.threads, kernel);
}

std::unique_ptr<Backend> make_gather_vectors(const System& system, const Integrator& integrator, double dt_s,
                                             const ExecutionOptions& options) {
  return make_gather_vectors(system, integrator, dt_s, options,
                             best_kernel(row_kernels(integrator), options.roots));
}

}  // namespace mssim
