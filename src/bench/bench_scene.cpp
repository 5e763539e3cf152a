#include "bench/bench_scene.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <future>
#include <map>
#include <numeric>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "bench/bench_memory.h"
#include "bench/expected_time.h"
#include "bench/job/combination.h"
#include "bench/roofline/machine_peak.h"
#include "bench/roofline/step_cost.h"
#include "bench/windows/window_verification.h"
#include "garment/bench/dressing_record.h"
#include "garment/bench/garment_verification.h"
#include "garment/stepping/dressing_backend.h"
#include "platform/process_cpus.h"
#include "statistics/statistics.h"
#include "text/counted.h"
#include "text/decimal.h"
#include "text/note.h"

namespace mssim {
namespace {

using Clock = std::chrono::steady_clock;

/// Peaks of this machine, by threads and bytes of the working set.
using Peaks = std::map<std::pair<int, std::size_t>, MachinePeak>;

/// What a step of the combination works on, in a scene of this size.
StepSize size_for(const Combination& combination, const StepSize& scene) {
  return combination.stored_springs ? with_stored_springs(scene, *combination.stored_springs) : scene;
}

/// Of the roofs that the combination is held against.
std::pair<int, std::size_t> peak_key(const Combination& combination, const StepSize& scene) {
  return {combination.row.threads,
          static_cast<std::size_t>(working_set_bytes(*combination.integrator, size_for(combination, scene)))};
}

/// Measures the peaks that the combinations are held against, now. None for a garment: what a step of it has
/// to do depends on what touches and what is sewn; none of a cloth that does not fit here; none for implicit
/// integrators, whose solvers go on for as long as it takes; and none where only samples are wanted.
Peaks measure_peaks(const SceneJob& job, const std::vector<Combination>& combinations, const StepSize& size,
                    const BenchWatch& watch) {
  Peaks peaks;
  if (job.garment || job.verified || job.windowed) return peaks;
  for (const Combination& combination : combinations) {
    if (is_implicit(*combination.integrator) || !combination.backend || !combination.on_host) continue;
    const auto [threads, bytes] = peak_key(combination, size);
    if (peaks.contains({threads, bytes})) continue;
    watch.progress("machine peak with " + counted(static_cast<std::uint64_t>(threads), "thread"),
                   job.preparation);
    peaks[{threads, bytes}] = measure_peak(threads, bytes);
  }
  return peaks;
}

void compare_with_peaks(const Combination& combination, const StepSize& size, const Peaks& peaks,
                        ResultRow& row) {
  if (!row.ms_per_step || row.dressing || is_implicit(*combination.integrator)) return;
  const StepCost cost =
      step_cost(*combination.integrator, size_for(combination, size), combination.steps_per_pass);
  const double seconds = *row.ms_per_step / 1000;
  row.gigabytes_per_second = cost.bytes / seconds / 1e9;
  if (const auto peak = peaks.find(peak_key(combination, size)); combination.on_host && peak != peaks.end())
    row.roofline_fraction = roofline_fraction(cost, seconds, peak->second);
  if (row.roofline_fraction && *row.roofline_fraction > 1)
    add_to_note(row.note,
                three_digits(100 * *row.roofline_fraction) +
                    " % of the roofline: faster than this machine was seen to do the work of a step; "
                    "does it take all steps, or was the machine busy when its peak was measured?");
}

/// Compares a backend with the reference.
using Verifier = std::function<Verification(Combination& combination)>;

/// Runs the reference. `draped`: the garment, settled; none where the scene is no garment or cannot be
/// dressed. The verifier is empty where no backend has the scene with this integrator.
Verifier make_verifier(const SceneJob& job, const Integrator& integrator,
                       const std::optional<State>& draped) {
  if (job.garment && !dresses(integrator)) return {};
  if (job.garment)
    return [&job, reference = run_garment_reference(*job.system, integrator, job.dt_s, *draped)](
               Combination& combination) {
      return verify_garment(*combination.backend, *job.system, reference, job.dt_s);
    };
  if (job.windowed)
    return [&job, &integrator,
            reference = run_window_references(*job.windowed, integrator, job.dt_s,
                                              static_cast<std::size_t>(job.execution.threads))](
               Combination& combination) {
      Verification found =
          verify_windows(*combination.windows, *job.windowed, integrator, reference, job.dt_s);
      if (!found.failure) add_to_note(combination.row.note, share_seen(*job.windowed));
      return found;
    };
  return [&job, reference = run_reference(*job.system, integrator, job.dt_s)](Combination& combination) {
    return verify(*combination.backend, *job.system, reference, job.dt_s);
  };
}

/// The backend as job.verified or else the comparison with the reference finds it.
Combination make_verified(const SceneJob& job, const BackendInfo& info, const Integrator& integrator,
                          const State& start, const Verifier& verifier) {
  Combination combination = make_combination(job, info, integrator, start);
  if (combination.backend && job.verified)
    take_verification(combination, *job.verified);
  else if (combination.backend)
    attempt(combination, [&] { take_verification(combination, verifier(combination)); });
  return combination;
}

/// What an integrator's reference leaves.
struct AfterReference {
  Verifier verifier;
  std::optional<Combination> serial;  ///< verified, if it is among the job's backends
};

/// Runs the references of all integrators and verifies `serial` with each. Both take one thread: as many run
/// at the same time as the other backends have threads. The results have the integrators' order.
std::vector<AfterReference> run_references(const SceneJob& job, const std::optional<State>& draped,
                                           const State& start) {
  std::vector<AfterReference> results(job.integrators.size());
  const auto serial =
      std::ranges::find_if(job.backends, [](const BackendInfo* info) { return info->name == "serial"; });
  // Those that take longer begin first.
  std::vector<std::size_t> order(results.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::greater(),
                           [&](std::size_t i) { return expected_evaluations(*job.integrators[i]); });
  const auto run = [&](const Integrator& integrator, AfterReference& result) {
    result.verifier = make_verifier(job, integrator, draped);
    if (serial != job.backends.end())
      result.serial = make_verified(job, **serial, integrator, start, result.verifier);
  };
  std::atomic<std::size_t> next = 0;
  const OnAllProcessCpus unbound;  // threads that OpenMP does not start would share the CPU of this one
  std::vector<std::future<void>> threads;
  for (std::size_t thread = 0; thread < (job.windowed ? 1 : references_at_once(job)); ++thread)
    threads.push_back(std::async(std::launch::async, [&] {
      for (std::size_t i = next++; i < order.size(); i = next++)
        run(*job.integrators[order[i]], results[order[i]]);
    }));
  for (std::future<void>& thread : threads) thread.get();
  return results;
}

/// What the samples so far say.
std::vector<ResultRow> rows_of(const std::vector<Combination>& combinations, const StepSize& size,
                               const Peaks& peaks) {
  std::vector<ResultRow> rows;
  for (const Combination& combination : combinations) {
    const auto serial = std::ranges::find_if(combinations, [&](const Combination& other) {
      return other.integrator == combination.integrator && other.row.backend == "serial";
    });
    ResultRow& row = rows.emplace_back(combination.row);
    summarise(row, serial == combinations.end() ? nullptr : &serial->row);
    summarise_costs(combination, row);
    compare_with_peaks(combination, size, peaks, row);
  }
  return rows;
}

/// Gives the combinations their earlier samples, as many as all of them have, and says how many those are.
int restore(std::vector<Combination>& combinations, const std::vector<ResultRow>& earlier) {
  std::size_t complete = SIZE_MAX;
  for (Combination& combination : combinations) {
    if (!combination.backend) continue;
    const auto row = std::ranges::find_if(
        earlier, [&](const ResultRow& other) { return same_combination(other, combination.row); });
    if (row != earlier.end()) {
      combination.row.samples_ms = row->samples_ms;
      combination.row.sample_steps = row->sample_steps;
      take_costs(combination.row, *row);
    }
    complete = std::min(complete, combination.row.samples_ms.size());
  }
  if (complete == SIZE_MAX) return 0;
  for (Combination& combination : combinations) {
    if (!combination.backend) continue;
    combination.row.samples_ms.resize(complete);
    combination.row.sample_steps.resize(complete);
  }
  return static_cast<int>(complete);
}

/// With which round this run began to measure, and when.
struct FirstRound {
  int number = 0;
  Clock::time_point start = Clock::now();
};

/// Says which sample comes next. `rounds`: those before it, and the share of its own that is done.
void tell_sample(const ResultRow& row, double rounds, const FirstRound& first, const SceneJob& job,
                 const BenchWatch& watch) {
  std::string activity = "round " + std::to_string(static_cast<int>(rounds) + 1);
  double done = (rounds - first.number) / (job.rounds - first.number);
  if (job.deadline) {
    const std::chrono::duration<double> spent = Clock::now() - first.start, all = *job.deadline - first.start;
    done = all > spent ? std::max(done, spent / all) : 1;
  } else {
    activity += '/' + std::to_string(job.rounds);
  }
  watch.progress(activity + ": " + row.integrator + ' ' + row.backend,
                 job.preparation + (1 - job.preparation) * done);
}

/// One sample of every combination, in this order. False when it was stopped, and then without a trace.
bool take_round(std::vector<Combination>& combinations, const std::vector<std::size_t>& order, int round,
                const FirstRound& first, const SceneJob& job, const BenchWatch& watch) {
  std::vector<std::pair<Combination*, std::optional<double>>> samples;
  for (std::size_t place = 0; place < order.size(); ++place) {
    const std::size_t i = order[place];
    if (!combinations[i].backend) continue;
    if (watch.stop()) return false;
    tell_sample(combinations[i].row, round + static_cast<double>(place) / static_cast<double>(order.size()),
                first, job, watch);
    samples.emplace_back(&combinations[i], sample_ms(combinations[i], job));
  }
  for (const auto& [combination, ms] : samples) {
    if (!ms) continue;
    combination->row.samples_ms.push_back(*ms);
    combination->row.sample_steps.push_back(combination->steps);
  }
  return true;
}

}  // namespace

std::vector<ResultRow> bench_scene(const SceneJob& job, const BenchWatch& watch) {
  const auto total = static_cast<double>(combinations(job));
  std::vector<Combination> all;
  const auto done = [&] { return job.preparation * static_cast<double>(all.size()) / total; };
  std::optional<State> draped;
  if (job.garment && std::ranges::any_of(job.integrators, [](const Integrator* i) { return dresses(*i); })) {
    watch.progress("drape", 0);
    draped = draped_state(job, watch.stop);
    if (!draped) return {};
  }
  const State& start = draped ? *draped : job.system->start;
  std::vector<AfterReference> references(job.integrators.size());
  if (!job.verified) {
    watch.progress("references", 0);
    if (watch.stop()) return {};
    references = run_references(job, draped, start);
  }
  for (std::size_t i = 0; i < job.integrators.size(); ++i) {
    const Integrator* integrator = job.integrators[i];
    for (const BackendInfo* info : job.backends) {
      watch.progress((job.verified ? "prepare: " : "verify: ") + std::string(integrator->name) + " " +
                         std::string(info->name),
                     done());
      if (watch.stop()) return {};
      auto& [verifier, serial] = references[i];
      Combination& combination =
          all.emplace_back(serial && info->name == serial->row.backend
                               ? std::move(*serial)
                               : make_verified(job, *info, *integrator, start, verifier));
      if (combination.backend && job.garment && !job.verified) {
        watch.progress("dress with " + std::string(info->name), done());
        if (!dress_combination(combination, job, watch.stop)) return {};
      }
      if (combination.backend) leave_untimed(combination);
      if (combination.backend) calibrate(combination, job);
    }
  }
  const StepSize size =
      job.windowed ? StepSize{job.windowed->nodes(), job.windowed->springs, 0} : step_size(*job.system);
  const Peaks peaks = measure_peaks(job, all, size, watch);

  std::vector<std::size_t> order(all.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::mt19937 random(20160101);  // any fixed seed: a run can be repeated
  const FirstRound first{restore(all, job.earlier)};
  for (int round = 0; round < job.rounds; ++round) {
    std::ranges::shuffle(order, random);
    if (round < first.number) continue;
    const int measured = round - first.number;
    if (job.deadline && measured > 0 &&
        Clock::now() + (Clock::now() - first.start) / measured > *job.deadline)
      break;
    if (!take_round(all, order, round, first, job, watch)) {
      if (round == 0) return {};
      break;
    }
    watch.after_round(rows_of(all, size, peaks));
  }
  std::ranges::for_each(all, end);
  return rows_of(all, size, peaks);
}

}  // namespace mssim
