#include "commands/bench/measured_scenes.h"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "bench/bench_scene.h"
#include "commands/bench/bench_trace.h"
#include "commands/shared/fit_body.h"
#include "commands/shared/prepared_scene.h"
#include "commands/shared/progress_line.h"
#include "platform/process.h"

namespace mssim {
namespace {

/// Adds to a job what the scene is. `scene` must outlive it.
void add_scene(SceneJob& job, const PreparedScene& scene) {
  job.system = &scene.system;
  job.springs_published = scene.counts.springs_published;
  job.note = scene.note;
  job.dt_s = scene.dt_s;
  if (scene.body) job.garment.emplace(GarmentJob{.body = fit_body(scene.body)});
}

}  // namespace

void measure_scenes(BenchPlan& plan, TimeBudget& budget, const StopRequest& stop, BenchResults& results) {
  const double rounds = expected_rounds(plan);
  std::vector<double> seconds;
  for (const ExpectedTime& time : times_of(plan.timed)) seconds.push_back(time.with(rounds));
  ProgressLine progress(seconds, ProgressLine::Log::scenes, budget.end());
  for (PlannedScene& planned : plan.timed) {
    SceneJob job{plan.settings};
    job.backends = planned.backends;
    job.name = planned.spec.name;
    job.execution.scene = job.name;
    job.execution.scene_file = planned.spec.file;
    job.deadline = budget.begin_scene();
    job.earlier = results.of_scene(job.name);
    progress.begin_scene(job.name);
    const bool finished = is_finished(job, job.name, job.earlier);
    if (finished && !plan.output.trace) {
      progress.skip_scene();
      planned.parts = {};
      continue;
    }
    const PreparedScene scene = planned.windows.empty() ? planned.prepare() : outline_of(planned);
    warn_of_note(scene);
    add_scene(job, scene);
    if (!planned.windows.empty())
      job.windowed = WindowedCloth{
          std::get<GridPatch>(scene.system.topology), scene.counts.springs_unique, planned.windows,
          [&](const GridWindow& window) { return build_window(scene.spec, window); }};
    job.preparation = planned.time.preparation / planned.time.with(rounds);
    bool first_round = true;
    const BenchWatch watch{
        .progress = [&](const std::string& activity, double done) { progress.update(activity, done); },
        .after_round =
            [&](const std::vector<ResultRow>& measured) {
              if (std::exchange(first_round, false)) budget.first_round_done();
              results.keep(job.name, measured);
            },
        .stop = [&] { return stop.requested(); }};
    try {
      std::vector<ResultRow> measured = finished ? std::vector<ResultRow>() : bench_scene(job, watch);
      if (!measured.empty()) results.keep(job.name, std::move(measured));
      std::vector<ResultRow> rows = results.of_scene(job.name);
      if (plan.output.trace && !stop.requested() &&
          write_bench_traces(job, scene, rows, results.stems_of_scene(job.name), plan.provenance,
                             std::filesystem::path(plan.output.folder) / "traces", plan.output.resume, watch))
        results.keep(job.name, std::move(rows));
    } catch (const Interrupted& interrupted) {
      // A wait for a program was cut short; the rounds before it are kept.
      note_ending_signal(interrupted.signal);
    }
    if (stop.requested()) return;
  }
}

}  // namespace mssim
