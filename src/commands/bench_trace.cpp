#include "commands/bench_trace.h"

#include "backends/backends.h"
#include "bench/verification.h"
#include "commands/run_provenance.h"
#include "commands/simulation.h"
#include "integrators/integrators.h"
#include "output/h5md_trace.h"
#include "output/write_error.h"

namespace mssim {
namespace {

/// Frames after the first.
constexpr int frames = 10;

}  // namespace

void write_bench_traces(const SceneJob& job, const PreparedScene& scene, const std::vector<ResultRow>& rows,
                        const std::filesystem::path& folder,
                        const std::function<void(const std::string& activity)>& progress) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    throw WriteError(folder.string() + " cannot be made a folder (" + error.message() +
                     "); choose another --out");
  const double duration_s = verification_steps * scene.dt_s;
  for (const ResultRow& row : rows) {
    if (row.status != "ok") continue;
    progress("trace " + row.backend + " " + row.integrator);
    const Integrator& integrator = *find_integrator(row.integrator);
    const auto backend = find_backend(row.backend)->make(scene.system, integrator, scene.dt_s, job.execution);
    H5mdTrace trace(folder / (row.scene + "-" + row.backend + "-" + row.integrator + ".h5"), scene.system,
                    trace_header(scene, *backend, row.backend, integrator));
    simulate(*backend, scene.system, {scene.dt_s, duration_s, frames / duration_s},
             [&](std::int64_t step, double time_s, const State& state, const Energy& energy) {
               trace.write_frame(step, time_s, state, energy);
             });
    trace.close();
  }
}

}  // namespace mssim
