#include "backends/openmp.h"

#include "backends/grid_bands/band_sheet.h"
#include "backends/grid_bands/step_bands.h"

namespace mssim {
namespace {

class OpenMp final : public Backend {
 public:
  OpenMp(const System& system, const GridPatch& grid, const Integrator& integrator, double dt_s, int threads)
      : kernel_(best_band_kernel()),
        sheet_(system, grid, integrator, dt_s, kernel_.lanes, static_cast<std::size_t>(threads)) {
    sheet_.set_state(system.start);
  }

  void set_state(const State& state) override { sheet_.set_state(state); }
  State state() const override { return sheet_.state(); }
  void step(int count) override { kernel_.step(sheet_, count); }
  std::string device() const override { return std::string("cpu ") + kernel_.instruction_set; }
  int threads() const override { return static_cast<int>(sheet_.parts.size()); }

 private:
  BandKernel kernel_;
  BandSheet sheet_;
};

}  // namespace

std::unique_ptr<Backend> make_openmp(const System& system, const Integrator& integrator, double dt_s,
                                     const ExecutionOptions& options) {
  return std::make_unique<OpenMp>(system, std::get<GridPatch>(system.topology), integrator, dt_s,
                                  options.threads);
}

}  // namespace mssim
