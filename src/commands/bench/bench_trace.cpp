#include "commands/bench/bench_trace.h"

#include <algorithm>

#include "bench/verification/verification.h"
#include "commands/shared/run_provenance.h"
#include "commands/shared/simulation.h"
#include "integrators/all_integrators.h"
#include "output/traces/h5md_trace.h"
#include "platform/files.h"
#include "text/error.h"

namespace mssim {
namespace {

/// Frames after the first.
constexpr int frames = 10;

void write_trace(const std::filesystem::path& file, const SceneJob& job, const PreparedScene& scene,
                 const ResultRow& row, const Provenance& provenance) {
  const double duration_s = verification_steps * scene.dt_s;
  const Integrator& integrator = *find_integrator(row.integrator);
  const BackendInfo& info = **std::ranges::find(job.backends, row.backend, &BackendInfo::name);
  const auto backend = make_backend(info, scene.system, integrator, scene.dt_s, job.execution);
  H5mdTrace trace(file, scene.system, trace_header(scene, *backend, row.backend, integrator, provenance));
  simulate(*backend, scene.system, integrator, {scene.dt_s, duration_s, frames / duration_s},
           {[&](const Frame& frame) {
             trace.write_frame(frame.step, frame.time_s, frame.state, frame.energy, frame.losses);
           }});
  trace.close();
}

}  // namespace

bool write_bench_traces(const SceneJob& job, const PreparedScene& scene, std::vector<ResultRow>& rows,
                        const std::vector<std::string>& stems, const Provenance& provenance,
                        const std::filesystem::path& folder, bool keep_existing, const BenchWatch& watch) {
  make_folder(folder);
  bool failed = false;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    ResultRow& row = rows[i];
    const std::filesystem::path file = folder / (stems[i] + ".h5");
    if (row.status != "ok" || (keep_existing && std::filesystem::exists(file))) continue;
    if (watch.stop()) break;
    const auto fail = [&](const char* reason) {
      row.status = std::string("failed: ") + reason;
      row.verified = false;
      failed = true;
    };
    watch.progress("trace " + row.backend + " " + row.integrator, 1);
    try {
      write_trace(file, job, scene, row, provenance);
    } catch (const BackendFailure& failure) {
      fail(failure.what());
      row.program_output = failure.output;
    } catch (const NotVerified& blow_up) {
      fail(blow_up.what());
    }
  }
  return failed;
}

}  // namespace mssim
