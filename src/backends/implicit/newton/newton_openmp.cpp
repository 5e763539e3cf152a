#include "backends/implicit/newton/newton_openmp.h"

namespace mssim {
namespace {

template <class Nodes>
class NewtonOpenMp final : public Backend {
 public:
  using Step = void (*)(VectorEquation<Nodes>& equation, int count);

  NewtonOpenMp(const System& system, Nodes nodes, const Integrator& integrator, double dt_s,
               const ExecutionOptions& options, const NewtonKernel& kernel, Step take_steps,
               std::size_t most_kept)
      : instruction_set_(kernel.instruction_set),
        step_(take_steps),
        equation_(system, std::move(nodes), integrator, dt_s, kernel.lanes,
                  static_cast<std::size_t>(options.threads), most_kept) {}

  void set_state(const State& state) override { equation_.set_state(state); }
  State state() const override { return equation_.state(); }
  void step(int count) override { step_(equation_, count); }
  std::string device() const override { return std::string("cpu ") + instruction_set_; }
  int threads() const override { return static_cast<int>(equation_.threads); }
  std::string note() const override { return note_of(equation_.work); }

 private:
  const char* const instruction_set_;
  const Step step_;
  VectorEquation<Nodes> equation_;
};

}  // namespace

std::unique_ptr<Backend> make_openmp_newton(const System& system, const Integrator& integrator, double dt_s,
                                            const ExecutionOptions& options, const NewtonKernel& kernel,
                                            std::size_t most_kept) {
  if (const auto* grid = std::get_if<GridPatch>(&system.topology))
    return std::make_unique<NewtonOpenMp<NodeRows>>(system, NodeRows(system, *grid, kernel.lanes), integrator,
                                                    dt_s, options, kernel, kernel.step_cloth, most_kept);
  return std::make_unique<NewtonOpenMp<NodeSlices>>(system, NodeSlices(system, kernel.lanes), integrator,
                                                    dt_s, options, kernel, kernel.step_bodies, most_kept);
}

std::unique_ptr<Backend> make_openmp_newton(const System& system, const Integrator& integrator, double dt_s,
                                            const ExecutionOptions& options) {
  return make_openmp_newton(system, integrator, dt_s, options, best_kernel(newton_kernels(), options.roots));
}

}  // namespace mssim
