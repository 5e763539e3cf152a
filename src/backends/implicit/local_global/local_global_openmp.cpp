#include <algorithm>
#include <variant>

#include "backends/implicit/local_global/local_global.h"
#include "backends/implicit/local_global/step_fronts.h"

namespace mssim {
namespace {

template <class Nodes>
class LocalGlobalVectors final : public Backend {
 public:
  using Step = void (*)(LocalGlobalNodes<Nodes>& system, int count);

  LocalGlobalVectors(const System& system, double dt_s, Nodes nodes, std::size_t lanes, int threads,
                     Step take_steps)
      : system_(system, dt_s, std::move(nodes), lanes, static_cast<std::size_t>(std::max(1, threads))),
        step_(take_steps) {}

  void set_state(const State& state) override { system_.set_state(state); }
  void step(int count) override { step_(system_, count); }
  State state() const override { return system_.state(); }
  std::string device() const override { return "cpu"; }
  int threads() const override { return static_cast<int>(system_.threads); }

 private:
  LocalGlobalNodes<Nodes> system_;
  const Step step_;
};

}  // namespace

std::unique_ptr<Backend> make_openmp_local_global(const System& system, double dt_s,
                                                  const ExecutionOptions& options) {
  const LocalGlobalKernel kernel = best_kernel(local_global_kernels(), options.roots);
  if (const auto* grid = std::get_if<GridPatch>(&system.topology))
    return std::make_unique<LocalGlobalVectors<NodeRows>>(system, dt_s, NodeRows(system, *grid, kernel.lanes),
                                                          kernel.lanes, options.threads, kernel.step_rows);
  return std::make_unique<LocalGlobalVectors<NodeSlices>>(system, dt_s, NodeSlices(system, kernel.lanes),
                                                          kernel.lanes, options.threads, kernel.step_slices);
}

}  // namespace mssim
