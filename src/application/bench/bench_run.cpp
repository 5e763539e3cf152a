#include "application/bench/bench_run.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "application/outputs.h"
#include "application/run.h"
#include "backends/backends.h"
#include "bench/verification/verification.h"
#include "integrators/all_integrators.h"
#include "output/traces/h5md_trace.h"
#include "platform/files.h"
#include "platform/process.h"
#include "scene/scene_kinds.h"
#include "text/error.h"

namespace mssim {
namespace {

/// Whether `member` of the row is one of `names`, and no row of the scene with the same value could run. A
/// backend that supports a garment with one of the integrators is not missed.
bool is_missed(const ResultRow& row, const std::vector<std::string>& names, std::string ResultRow::*member,
               const std::vector<ResultRow>& rows) {
  return std::ranges::find(names, row.*member) != names.end() &&
         std::ranges::none_of(rows, [&](const ResultRow& other) {
           return other.scene == row.scene && other.*member == row.*member && other.verified;
         });
}

template <class IsBad>
std::vector<std::string> reasons(const std::vector<ResultRow>& rows, IsBad is_bad) {
  std::vector<std::string> sentences;
  for (const ResultRow& row : rows)
    if (is_bad(row)) sentences.push_back(combination_name(row) + ": " + status_of(row));
  return sentences;
}

/// Frames after the first.
constexpr int frames = 10;

void write_trace(const std::filesystem::path& file, const SceneJob& job, const PreparedScene& scene,
                 const ResultRow& row, const Provenance& provenance) {
  const double duration_s = verification_steps * scene.dt_s;
  const Integrator& integrator = *find_integrator(row.integrator);
  const BackendInfo& info = **std::ranges::find(job.backends, row.backend, &BackendInfo::name);
  const auto backend = make_backend(info, scene.system, integrator, scene.dt_s, job.execution);
  H5mdTrace trace(file, scene.system, trace_header(scene, *backend, info, integrator, provenance));
  simulate(*backend, scene.system, integrator, {scene.dt_s, duration_s, frames / duration_s},
           {[&](const Frame& frame) {
             trace.write_frame(frame.step, frame.time_s, frame.state, frame.energy, frame.losses);
           }});
  trace.close();
}

double seconds_of(TimeBudget::Clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

TimeBudget::Clock::duration duration_of(double seconds) {
  return std::chrono::duration_cast<TimeBudget::Clock::duration>(std::chrono::duration<double>(seconds));
}

/// The job of a scene without earlier rows and a deadline. `scene` must outlive it.
SceneJob job_of(const BenchSettings& settings, const PlannedScene& planned, const PreparedScene& scene) {
  SceneJob job{settings};
  job.backends = planned.backends;
  job.execution.scene = planned.spec.name;
  job.execution.scene_file = planned.spec.file;
  job.system = &scene.system;
  job.springs_published = scene.counts.springs_published;
  job.note = scene.note;
  job.dt_s = scene.dt_s;
  if (scene.body) job.garment.emplace(GarmentJob{.body = fit_body(scene.body)});
  if (!planned.windows.empty())
    job.windowed = WindowedCloth{
        std::get<GridPatch>(scene.system.topology), scene.counts.springs_unique, planned.windows,
        [&scene](const GridWindow& window) { return build_window(scene.spec, window); }};
  return job;
}

}  // namespace

BenchVerdict verdict_of(const std::vector<ResultRow>& rows, const std::vector<std::string>& asked_backends,
                        const std::vector<std::string>& asked_integrators) {
  BenchVerdict verdict{exit_not_verified, reasons(rows, is_wrong)};
  if (!verdict.reasons.empty()) return verdict;
  verdict = {exit_unavailable, reasons(rows, [&](const ResultRow& row) {
               return is_missed(row, asked_backends, &ResultRow::backend, rows) ||
                      is_missed(row, asked_integrators, &ResultRow::integrator, rows);
             })};
  if (verdict.reasons.empty()) verdict.exit_code = exit_ok;
  return verdict;
}

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
      row.status = fmt::format("failed: {}, while it was traced", reason);
      row.verified = false;
      static_cast<SampleStatistics&>(row) = {};
      if (row.backend == baseline_backend().name)
        for (ResultRow& other : rows)
          if (other.integrator == row.integrator) other.speedup_vs_serial.reset();
      failed = true;
    };
    watch.progress(fmt::format("trace {} {}", row.backend, row.integrator), 1);
    try {
      write_trace(file, job, scene, row, provenance);
    } catch (const BackendFailure& failure) {
      fail(failure.what());
      row.program_output = failure.output;
    } catch (const NotVerified& blow_up) {
      fail(blow_up.what());
    } catch (const Unavailable& unavailable) {  // it ran a moment ago
      fail(unavailable.what());
    }
  }
  return failed;
}

TimeBudget::TimeBudget(std::optional<double> seconds, std::vector<ExpectedTime> scenes)
    : scenes_(std::move(scenes)), present_start_(Clock::now()) {
  if (!seconds) return;
  const ExpectedTime all = total(scenes_);
  const double least = all.with(1);
  if (*seconds < least)
    throw UsageError(
        "--time-budget is too short: one round of all this takes about {} s; give more, or name fewer "
        "scenes, backends or integrators",
        std::lround(std::ceil(least)));
  end_ = present_start_ + duration_of(*seconds);
}

std::optional<TimeBudget::Clock::time_point> TimeBudget::deadline() const {
  if (!end_ || present_.round == 0) return end_;  // without a limit, or of a skipped scene
  const Clock::time_point now = Clock::now();
  const double scale = expected_ > 0 ? taken_ / expected_ : 1;
  std::vector<ExpectedTime> left = scenes_;
  left.push_back(present_);
  const double rounds = rounds_within(seconds_of(*end_ - now) / scale, total(left));
  return now + duration_of(scale * present_.with(rounds));
}

std::optional<TimeBudget::Clock::time_point> TimeBudget::begin_scene() {
  present_start_ = Clock::now();
  present_ = scenes_.front();
  scenes_.erase(scenes_.begin());
  return deadline();
}

std::optional<TimeBudget::Clock::time_point> TimeBudget::first_round_done() {
  expected_ += present_.preparation + present_.round;
  taken_ += seconds_of(Clock::now() - present_start_);
  present_.preparation = -present_.round;  // of all its rounds, one is done
  return deadline();
}

std::vector<std::string> measure_scenes(BenchPlan& plan, TimeBudget& budget, const StopRequest& stop,
                                        BenchResults& results) {
  std::vector<std::string> lost;
  const double rounds = expected_rounds(plan);
  const auto seconds =
      mapped<double>(times_of(plan.timed), [&](const ExpectedTime& time) { return time.with(rounds); });
  std::set<std::string> finished_ones;  // known before a scene is measured: --resume may refuse a later one
  for (std::size_t i = 0; i < plan.timed.size(); ++i) {
    const PlannedScene& planned = plan.timed[i];
    BenchSettings settings = plan.settings;
    settings.backends = planned.backends;
    if (!is_finished(settings, planned.spec.name, results.of_scene(planned.spec.name), plan.output.folder))
      continue;
    finished_ones.insert(planned.spec.name);
    budget.skip(i);
  }
  ProgressLine progress(seconds, ProgressLine::Log::scenes, budget.end());
  for (PlannedScene& planned : plan.timed) {
    const std::string& name = planned.spec.name;
    const std::optional<TimeBudget::Clock::time_point> deadline = budget.begin_scene();
    progress.begin_scene(name);
    const bool finished = finished_ones.contains(name);
    if (finished && !plan.output.trace) {
      progress.skip_scene();
      planned.parts = {};
      continue;
    }
    try {  // other programs may have taken the memory that was there
      if (planned.windows.empty()) require_memory(planned.spec, planned.parts.counts);
    } catch (const ErrorWith<exit_bad_input>& error) {
      if (plan.timed.size() == 1) throw;
      lost.emplace_back(error.what());
      progress.skip_scene();
      continue;
    }
    const PreparedScene scene = planned.windows.empty() ? planned.prepare() : outline_of(planned);
    warn_of_note(scene);
    SceneJob job = job_of(plan.settings, planned, scene);
    job.deadline = deadline;
    job.earlier = results.of_scene(name);
    job.preparation = planned.time.preparation / planned.time.with(rounds);
    bool first_round = true;
    const BenchWatch watch{
        .progress = [&](const std::string& activity, double done) { progress.update(activity, done); },
        .after_round =
            [&](const std::vector<ResultRow>& measured) {
              if (std::exchange(first_round, false)) job.deadline = budget.first_round_done();
              results.keep(name, measured);
            },
        .stop = [&] { return stop.requested(); }};
    try {
      std::vector<ResultRow> measured = finished ? std::vector<ResultRow>() : bench_scene(job, watch);
      if (!measured.empty()) results.keep(name, std::move(measured));
      std::vector<ResultRow> rows = results.of_scene(name);
      if (plan.output.trace && !stop.requested()) {
        write_bench_traces(job, scene, rows, results.stems_of_scene(name), plan.provenance,
                           std::filesystem::path(plan.output.folder) / traces_name, plan.output.resume,
                           watch);
        results.keep(name, std::move(rows));  // the provenance then says that there are traces
      }
    } catch (const Interrupted& interrupted) {
      // An interrupted wait for a program; the completed rounds are kept.
      note_ending_signal(interrupted.signal);
    }
    if (stop.requested()) break;
  }
  return lost;
}

}  // namespace mssim
