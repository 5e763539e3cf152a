#include "bench/bench_scene.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <numeric>
#include <random>

#include "bench/blow_up.h"
#include "bench/machine_peak.h"
#include "bench/statistics.h"
#include "bench/step_cost.h"
#include "bench/verification.h"

namespace mssim {
namespace {

/// A row under way.
struct Combination {
  ResultRow row;
  const Integrator* integrator = nullptr;
  bool on_host = true;
  int steps_per_pass = 0;
  std::unique_ptr<Backend> backend;  ///< null once the row has failed
  int steps = 1;                     ///< in a sample
};

/// Runs the steps of one sample from the start state and returns its wall-clock seconds.
double time_sample(Backend& backend, const State& start, int steps) {
  using Clock = std::chrono::steady_clock;
  backend.set_state(start);
  backend.step(1);  // wakes threads and caches up
  backend.set_state(start);
  const auto before = Clock::now();
  backend.step(steps);
  return std::chrono::duration<double>(Clock::now() - before).count();
}

void fail(Combination& combination, const std::string& status) {
  combination.row.status = status;
  combination.row.verified = false;
  combination.backend.reset();
}

/// Makes the backend; a reason not to becomes the row's status.
Combination prepare(const SceneJob& job, const BackendInfo& info, const Integrator& integrator) {
  Combination combination;
  combination.integrator = &integrator;
  ResultRow& row = combination.row;
  row.scene = job.name;
  row.nodes = job.system->nodes();
  row.springs_unique = job.system->springs.size();
  row.springs_published = job.springs_published;
  row.note = job.note;
  row.backend = info.name;
  row.integrator = integrator.name;
  row.dt_s = job.dt_s;
  try {
    combination.backend = info.make(*job.system, integrator, job.dt_s, job.execution);
    row.device = combination.backend->device();
    row.threads = combination.backend->threads();
    combination.on_host = combination.backend->runs_on_host();
    combination.steps_per_pass = combination.backend->steps_per_pass();
  } catch (const Unavailable& reason) {
    fail(combination, std::string("unavailable: ") + reason.what());
  } catch (const Unsupported& reason) {
    fail(combination, std::string("unsupported: ") + reason.what());
  }
  return combination;
}

void check(Combination& combination, const SceneJob& job, const Reference& reference) {
  const Verification verification = verify(*combination.backend, *job.system, reference, job.dt_s);
  combination.row.position_error = verification.position_error;
  combination.row.energy_drift = verification.energy_drift;
  combination.row.verified = !verification.failure;
  if (verification.failure) fail(combination, "failed: " + *verification.failure);
}

/// Finds how many steps fill a sample, from ever longer trials.
void calibrate(Combination& combination, const SceneJob& job) {
  for (;;) {
    const double seconds = time_sample(*combination.backend, job.system->start, combination.steps);
    const double fit = combination.steps * job.sample_seconds / std::max(seconds, 1e-9);
    const int steps = static_cast<int>(std::clamp(fit, 1.0, static_cast<double>(max_sample_steps)));
    if (steps <= 2 * combination.steps) {
      combination.steps = std::max(1, steps);
      return;
    }
    combination.steps = std::min(steps, 10 * combination.steps);
  }
}

void take_sample(Combination& combination, const SceneJob& job) {
  const double seconds = time_sample(*combination.backend, job.system->start, combination.steps);
  combination.row.samples_ms.push_back(1000 * seconds / combination.steps);
  combination.row.sample_steps.push_back(combination.steps);
  if (first_bad_node(combination.backend->state())) {
    const auto blow_up = find_blow_up(*combination.backend, job.system->start, combination.steps);
    fail(combination, "failed: " + (blow_up ? describe(*blow_up, job.dt_s)
                                            : "not finite in one run, finite in the next: a data race"));
  }
}

/// The times of a row that has samples. `serial`: the baseline's row of the same integrator, or null.
void summarise(Combination& combination, const ResultRow* serial) {
  ResultRow& row = combination.row;
  row.rounds = static_cast<int>(row.samples_ms.size());
  if (row.status != "ok" || row.samples_ms.empty()) return;
  const MedianInterval time = median_interval(row.samples_ms);
  row.ms_per_step = time.median;
  row.ms_per_step_low = time.low;
  row.ms_per_step_high = time.high;
  row.ms_per_step_min = *std::min_element(row.samples_ms.begin(), row.samples_ms.end());
  row.springs_per_second = 1000 / time.median * static_cast<double>(row.springs_unique) *
                           static_cast<double>(combination.integrator->stage_count);
  if (serial != nullptr && serial->samples_ms.size() == row.samples_ms.size())
    row.speedup_vs_serial = median_ratio(serial->samples_ms, row.samples_ms).median;
}

/// Holds the rows' medians against the peaks of this machine, measured now for each working set and thread
/// count.
void compare_with_peaks(std::vector<Combination>& combinations, const StepSize& size,
                        const Progress& progress) {
  std::map<std::pair<const Integrator*, int>, MachinePeak> peaks;
  for (Combination& combination : combinations) {
    ResultRow& row = combination.row;
    if (!row.ms_per_step) continue;
    const StepCost cost = step_cost(*combination.integrator, size, combination.steps_per_pass);
    const double seconds = *row.ms_per_step / 1000;
    row.gigabytes_per_second = cost.bytes / seconds / 1e9;
    if (!combination.on_host) continue;
    const auto key = std::pair(combination.integrator, row.threads);
    if (!peaks.contains(key)) {
      progress("machine peak with " + std::to_string(row.threads) + " threads", 1);
      const double bytes = working_set_bytes(*combination.integrator, size);
      peaks[key] = measure_peak(row.threads, static_cast<std::size_t>(bytes));
    }
    row.roofline_fraction = roofline_fraction(cost, seconds, peaks[key]);
  }
}

}  // namespace

std::vector<ResultRow> bench_scene(const SceneJob& job, const Progress& progress) {
  const std::size_t total = job.integrators.size() * job.backends.size();
  // The share of the whole that verification and calibration take, for the progress only.
  constexpr double preparation = 0.3;
  std::vector<Combination> combinations;
  combinations.reserve(total);
  for (const Integrator* integrator : job.integrators) {
    progress("reference " + std::string(integrator->name),
             preparation * static_cast<double>(combinations.size()) / static_cast<double>(total));
    const Reference reference = run_reference(*job.system, *integrator, job.dt_s);
    for (const BackendInfo* info : job.backends) {
      progress("verify " + std::string(info->name) + " " + std::string(integrator->name),
               preparation * static_cast<double>(combinations.size()) / static_cast<double>(total));
      Combination& combination = combinations.emplace_back(prepare(job, *info, *integrator));
      if (combination.backend) check(combination, job, reference);
      if (combination.backend) calibrate(combination, job);
    }
  }

  std::vector<std::size_t> order(combinations.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::mt19937 random(20160101);  // any fixed seed: a run can be repeated
  for (int round = 0; round < job.rounds; ++round) {
    progress("round " + std::to_string(round + 1) + " of " + std::to_string(job.rounds),
             preparation + (1 - preparation) * round / job.rounds);
    std::shuffle(order.begin(), order.end(), random);
    for (const std::size_t i : order)
      if (combinations[i].backend) take_sample(combinations[i], job);
  }

  for (Combination& combination : combinations) {
    const auto serial = std::find_if(combinations.begin(), combinations.end(), [&](const Combination& other) {
      return other.integrator == combination.integrator && other.row.backend == "serial";
    });
    summarise(combination, serial == combinations.end() ? nullptr : &serial->row);
  }
  compare_with_peaks(combinations, step_size(*job.system), progress);

  std::vector<ResultRow> rows;
  rows.reserve(combinations.size());
  for (Combination& combination : combinations) rows.push_back(std::move(combination.row));
  return rows;
}

}  // namespace mssim
