#include "garment/stepping/openmp_dressing.h"

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "garment/stepping/dressing_rules.h"
#include "garment/stepping/step_panels.h"

namespace mssim {
namespace {

class OpenMpDressing final : public DressingBackend {
 public:
  OpenMpDressing(const System& system, double dt_s, std::size_t threads, const PanelKernel& kernel)
      : kernel_(kernel),
        dressing_{system,
                  std::get<Garment>(system.topology),
                  GarmentGrid(system),
                  threads,
                  dt_s,
                  layer_collision(system, std::get<Garment>(system.topology), static_cast<int>(threads))} {
    OpenMpDressing::set_state(system.start);
  }

  void set_state(const State& state) override {
    dressing_.grid.set_state(state);
    dressing_.steps = 0;
    dressing_.progress = first_progress(dressing_.garment, state);
  }
  void step(int count) override { kernel_.step(dressing_, count); }
  State state() const override {
    State state = dressing_.grid.state();
    state.draped = dressing_.progress.draping;
    return state;
  }
  std::string device() const override { return "cpu"; }
  int threads() const override { return static_cast<int>(dressing_.threads); }
  DressingProgress progress() const override { return dressing_.progress; }

 private:
  PanelKernel kernel_;
  PanelDressing dressing_;
};

}  // namespace

std::vector<std::string_view> dressing_instruction_sets() {
  std::vector<std::string_view> names;
  for (const PanelKernel& kernel : panel_kernels()) names.emplace_back(kernel.instruction_set);
  return names;
}

std::unique_ptr<DressingBackend> make_openmp_dressing(const System& system, const Integrator& integrator,
                                                      double dt_s, int threads,
                                                      std::string_view instruction_set) {
  require_semi_euler(integrator);
  for (const PanelKernel& kernel : panel_kernels())
    if (instruction_set.empty() || instruction_set == kernel.instruction_set)
      return std::make_unique<OpenMpDressing>(system, dt_s, static_cast<std::size_t>(threads), kernel);
  throw std::invalid_argument("openmp has no vector code for " + std::string(instruction_set) +
                              " that this processor can run");
}

}  // namespace mssim
