#include "backends/implicit/constraints/constraints_openmp.h"

#include <string>

#include "backends/implicit/constraints/constraints.h"

namespace mssim {
namespace {

/// Vector code on its layout.
template <class Kernel, class Layout>
class OpenMpConstraints final : public Backend {
 public:
  template <class... Arguments>
  explicit OpenMpConstraints(const Kernel& kernel, int threads, const Arguments&... arguments)
      : kernel_(kernel), layout_(arguments..., kernel.lanes, static_cast<std::size_t>(threads)) {}

  void set_state(const State& state) override { layout_.set_state(state); }
  State state() const override { return layout_.state(); }
  void step(int count) override { kernel_.step(layout_, count); }
  std::string device() const override { return std::string("cpu ") + kernel_.instruction_set; }
  int threads() const override { return static_cast<int>(layout_.threads); }

 private:
  Kernel kernel_;
  Layout layout_;
};

}  // namespace

std::unique_ptr<Backend> make_openmp_constraints(const System& system, double dt_s, int threads,
                                                 const ClothConstraintKernel& kernel) {
  const auto* grid = std::get_if<GridPatch>(&system.topology);
  if (grid == nullptr) throw Unsupported("this vector code steps cloths");
  return std::make_unique<OpenMpConstraints<ClothConstraintKernel, QuarteredRows>>(kernel, threads, system,
                                                                                   *grid, dt_s);
}

std::unique_ptr<Backend> make_openmp_constraints(const System& system, double dt_s, int threads,
                                                 const BodyConstraintKernel& kernel) {
  return std::make_unique<OpenMpConstraints<BodyConstraintKernel, SpringBatches>>(kernel, threads, system,
                                                                                  dt_s);
}

std::unique_ptr<Backend> make_openmp_constraints(const System& system, double dt_s,
                                                 const ExecutionOptions& options) {
  if (std::holds_alternative<GridPatch>(system.topology))
    return make_openmp_constraints(system, dt_s, options.threads,
                                   best_kernel(cloth_constraint_kernels(), options.roots));
  return make_openmp_constraints(system, dt_s, options.threads,
                                 best_kernel(body_constraint_kernels(), options.roots));
}

}  // namespace mssim
