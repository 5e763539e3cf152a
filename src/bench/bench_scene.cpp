#include "bench/bench_scene.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <random>
#include <utility>

#include "bench/estimates.h"
#include "bench/roofline/roofline.h"
#include "bench/verification/verification.h"
#include "bench/windows/windows.h"
#include "garment/bench/garment_bench.h"
#include "garment/stepping/dressing_backend.h"
#include "platform/machine.h"
#include "platform/process.h"
#include "text/text.h"

namespace mssim {
namespace {

using Clock = std::chrono::steady_clock;

/// Sets the least costs of the combinations' steps, and measures the peaks that they are compared with.
/// Implicit integrators, whose solvers iterate until they converge, have neither. There are no peaks for a
/// garment, whose work per step depends on what touches and what is sewn; for a cloth in windows; for a
/// program that reports more threads than make sense; and for a job that only takes samples.
void measure_peaks(const SceneJob& job, std::vector<Combination>& combinations, const BenchWatch& watch) {
  const StepSize scene =
      job.windowed ? StepSize{job.windowed->nodes(), job.windowed->springs, 0} : step_size(*job.system);
  std::map<std::pair<int, std::size_t>, MachinePeak> peaks;  // by threads and bytes of the working set
  for (Combination& combination : combinations) {
    if (is_implicit(*combination.integrator) || !combination.in_single || !combination.backend) continue;
    const Backend& backend = *combination.backend;
    const std::optional<std::uint64_t> stored = backend.stored_springs();
    const StepSize size = stored ? with_stored_springs(scene, *stored) : scene;
    combination.cost = step_cost(*combination.integrator, size, backend.steps_per_pass());
    const int threads = combination.row.threads;
    if (job.garment || job.verified || job.windowed || !backend.runs_on_host() || thread_excess(threads))
      continue;
    const auto bytes = static_cast<std::size_t>(working_set_bytes(*combination.integrator, size));
    const auto [peak, is_new] = peaks.try_emplace({threads, bytes});
    if (is_new) {
      watch.progress("machine peak with " + pluralize(threads, "thread"), job.preparation);
      peak->second = measure_peak(threads, bytes);
    }
    combination.peak = peak->second;
  }
}

void compare_with_peak(const Combination& combination, ResultRow& row) {
  if (!row.ms_per_step || row.dressing || !combination.cost) return;
  const double seconds = *row.ms_per_step / 1000;
  row.gigabytes_per_second = combination.cost->bytes / seconds / 1e9;
  if (combination.peak)
    row.roofline_fraction = roofline_fraction(*combination.cost, seconds, *combination.peak);
  if (row.roofline_fraction && *row.roofline_fraction > 1)
    append_sentence(
        row.note,
        three_digits(100 * *row.roofline_fraction) +
            " % of the roofline: faster than the measured peak of this machine allows; does the backend "
            "take all steps, or was the machine busy when its peak was measured?");
}

/// Programs that run in ranks read the scene file, whatever System they are made for.
bool builds_scenes_itself(const BackendInfo& info) {
  return info.program != nullptr && info.program->in_ranks;
}

/// Steps the second stretch with another instance of the backend. The row's note says if the stretch is so
/// short that it shows little: short time steps move nodes by no more than roundings.
void verify_second(Combination& combination, const SceneJob& job, const BackendInfo& info,
                   const SecondStretch& stretch) {
  constexpr int short_part = 8;
  if (short_part * stretch.steps < stretch.most_steps || stretch.landed == 0)
    append_sentence(combination.row.note,
                    fmt::format("the second stretch could be compared for {} of {}{}: roundings may hide "
                                "small faults",
                                stretch.steps, pluralize(stretch.most_steps, "step"),
                                stretch.landed == 0 ? ", in which nothing landed" : ""));
  combination.backend->rest();
  ExecutionOptions execution = job.execution;
  execution.scene += "-small";  // a program may know scenes by their names
  const std::string cannot = "failed: it does not step a small scene of the same kind: ";
  try {
    const auto backend = make_backend(info, stretch.system, *combination.integrator, job.dt_s, execution);
    if (const auto wrong = verify_second(*backend, stretch)) fail(combination, "failed: " + *wrong);
  } catch (const Unsupported& reason) {
    fail(combination, cannot + reason.what());
  } catch (const Unavailable& reason) {
    fail(combination, cannot + reason.what());
  } catch (const BackendFailure& failure) {
    throw BackendFailure(std::string(failure.what()) + ", on a small scene of the same kind", failure.output,
                         failure.late);
  }
}

/// Compares the combination's backend with the reference, and takes the verdict.
using Verifier = std::function<void(Combination& combination, const BackendInfo& info)>;

/// Runs the reference; for a garment, when a backend is first compared with it. `start`: of all samples; must
/// outlive the verifier. Sets `step_seconds` to the reference's time per step if the ends of samples are
/// compared with it too. The verifier is empty if no backend supports the scene with this integrator.
Verifier make_verifier(const SceneJob& job, const Integrator& integrator, const State& start,
                       double& step_seconds) {
  if (job.garment && !dresses(integrator)) return {};
  if (job.garment)
    return [&job, &integrator, &start,
            references = std::map<decltype(BackendInfo::make_dressing_reference), GarmentReference>()](
               Combination& combination, const BackendInfo& info) mutable {
      const auto make = info.make_dressing_reference;
      auto found = references.find(make);
      if (found == references.end())
        found = references
                    .emplace(make, run_garment_reference(*make(*job.system, integrator, job.dt_s),
                                                         *job.system, integrator, job.dt_s, start))
                    .first;
      take_verification(combination,
                        verify_garment(*combination.backend, *job.system, found->second, job.dt_s));
    };
  if (job.windowed)
    return [&job, reference = std::make_shared<const WindowReferences>(run_window_references(
                      *job.windowed, integrator, job.dt_s, static_cast<std::size_t>(job.execution.threads)))](
               Combination& combination, const BackendInfo& /*info*/) {
      take_verification(combination, verify_windows(*combination.backend, *reference));
      if (!combination.backend) return;
      append_sentence(combination.row.note, share_seen(*job.windowed));
      combination.most_steps = reference->steps;
      combination.compare_windows = [reference](Backend& backend, const State& state, int steps) {
        return compare_windows(backend, state, *reference, steps);
      };
    };
  const auto refer = [&job, &integrator](bool anew) {
    return job.references ? recall_reference(*job.references, *job.system, integrator, job.dt_s, anew)
                          : run_reference(*job.system, integrator, job.dt_s);
  };
  Reference reference = refer(false);
  step_seconds = reference.step_seconds;
  std::optional<SecondStretch> second;
  if (!is_implicit(integrator)) second = run_second_stretch(*job.system, integrator, job.dt_s);
  return [&job, refer, reference = std::move(reference), second = std::move(second)](
             Combination& combination, const BackendInfo& info) mutable {
    Verification found =
        verify(*combination.backend, *job.system, reference, job.dt_s, combination.steps_taken);
    if (found.failure && reference.recalled) {  // a cached file must not make a row fail
      reference = refer(true);
      found = verify(*combination.backend, *job.system, reference, job.dt_s);
    }
    if (reference.recalled)
      append_sentence(combination.row.note, "compared with a reference of an earlier run");
    take_verification(combination, found);
    if (combination.backend && second && !builds_scenes_itself(info))
      verify_second(combination, job, info, *second);
  };
}

/// Largest number of steps of a sample whose end can be compared with the reference.
int most_sample_steps(const SceneJob& job, const Integrator& integrator) {
  if (job.garment) return max_sample_steps;  // its ends are not compared
  if (job.windowed) return verification_steps;
  const int checkable =
      checkable_steps(integrator, {job.system->nodes(), job.system->springs.size(), false, false});
  return comparable_steps(*job.system, integrator, job.dt_s, checkable);
}

/// Results of an integrator's reference.
struct AfterReference {
  int most_steps = max_sample_steps;  ///< of a sample
  double step_seconds = 0;            ///< time per step of the reference
  Verifier verifier = {};
  std::optional<Combination> serial = {};  ///< verified in the end, if it is among the job's backends
};

/// Makes the backend, which is judged after at most `most_steps` steps.
Combination make_unjudged(const SceneJob& job, const BackendInfo& info, const Integrator& integrator,
                          const State& start, int most_steps) {
  Combination combination = make_combination(job, info, integrator, start);
  combination.most_steps = most_steps;
  if (most_steps < verification_steps)
    append_sentence(
        combination.row.note,
        fmt::format("compared and timed in no more than {}, in which the integrator doubles a rounding",
                    pluralize(most_steps, "step")));
  return combination;
}

/// Takes the verdict of job.verified or, without it, of the comparison with the reference.
void judge(Combination& combination, const SceneJob& job, const BackendInfo& info,
           const AfterReference& reference) {
  if (combination.backend && job.verified)
    take_verification(combination, *job.verified);
  else if (combination.backend)
    attempt(combination, [&] { reference.verifier(combination, info); });
}

/// Calls `work`, which takes one thread, for each of the job's integrators, by number, and for each of
/// `parts` independent parts. Runs as many at the same time as the backends have threads, longest first.
void for_each_integrator(const SceneJob& job, std::size_t parts,
                         const std::function<void(std::size_t i, std::size_t part)>& work) {
  const std::vector<std::size_t> order = ordered_places<std::greater<>>(
      job.integrators, [](const Integrator* integrator) { return expected_evaluations(*integrator); });
  for_each_at_once(parts * order.size(), job.windowed ? 1 : static_cast<std::size_t>(job.execution.threads),
                   [&](std::size_t task) { work(order[task / parts], task % parts); });
}

/// Takes the steps after which a reference that does not end before contact is compared. Throws Interrupted
/// like run_reference.
void step_beside_reference(Combination& combination, const SceneJob& job) {
  const int steps = std::min(combination.most_steps, verification_steps);
  combination.backend->set_state(job.system->start);
  while (combination.steps_taken < steps) {
    if (const int signal = noted_ending_signal()) throw Interrupted{signal};
    const int count = std::min(steps - combination.steps_taken, steps_between_looks);
    combination.backend->step(count);
    combination.steps_taken += count;
  }
}

/// Runs the references of all integrators and, without job.verified, verifies `serial` with each. The results
/// are in the integrators' order. `serial` steps while the references run; for a garment it steps after them,
/// because it restarts from states of the reference.
std::vector<AfterReference> run_references(const SceneJob& job, const State& start) {
  std::vector<AfterReference> results(job.integrators.size());
  for_each_integrator(job, 1, [&](std::size_t i, std::size_t /*part*/) {
    results[i].most_steps = most_sample_steps(job, *job.integrators[i]);
  });
  if (job.verified) return results;
  const auto serial = std::ranges::find_if(
      job.backends, [](const BackendInfo* info) { return info->role == BackendRole::baseline; });
  const bool has_serial = serial != job.backends.end();
  // While nothing else runs, because its time and memory are measured.
  for (std::size_t i = 0; has_serial && i < results.size(); ++i)
    results[i].serial = make_unjudged(job, **serial, *job.integrators[i], start, results[i].most_steps);
  for_each_integrator(job, has_serial && !job.garment ? 2 : 1, [&](std::size_t i, std::size_t part) {
    if (part == 0)
      results[i].verifier = make_verifier(job, *job.integrators[i], start, results[i].step_seconds);
    else if (Combination& made = *results[i].serial; made.backend)
      attempt(made, [&] { step_beside_reference(made, job); });
  });
  if (has_serial)
    for_each_integrator(job, 1, [&](std::size_t i, std::size_t /*part*/) {
      judge(*results[i].serial, job, **serial, results[i]);
    });
  return results;
}

/// Rows of the samples so far. `are_checked`: the checks after the last round are done.
std::vector<ResultRow> rows_of(const std::vector<Combination>& combinations, bool are_checked) {
  std::vector<ResultRow> rows;
  for (const Combination& combination : combinations) {
    const auto serial = std::ranges::find_if(combinations, [&](const Combination& other) {
      return other.integrator == combination.integrator && other.row.backend == baseline_backend().name &&
             counts(other.row);
    });
    ResultRow& row = rows.emplace_back(combination.row);
    summarise(row, serial == combinations.end() ? nullptr : &serial->row);
    summarise_costs(combination, row);
    compare_with_peak(combination, row);
    if (row.status == "ok" && !are_checked) append_sentence(row.note, unchecked_samples);
    require_finite(row);
  }
  return rows;
}

/// Gives the combinations their earlier samples, as many as all of them have, and returns how many. A row
/// that failed although it has all samples was found out after them, and fails again.
int restore(std::vector<Combination>& combinations, const std::vector<ResultRow>& earlier) {
  std::size_t complete = SIZE_MAX, most = 0;
  for (const ResultRow& row : earlier)
    if (counts(row)) most = std::max(most, row.samples_ms.size());
  for (Combination& combination : combinations) {
    if (!combination.backend) continue;
    if (const ResultRow* row = find_combination(earlier, combination.row)) {
      if (is_wrong(*row) && row->samples_ms.size() >= most) {
        if (most > 0) fail(combination, row->status);
        continue;
      }
      static_cast<Samples&>(combination.row) = static_cast<const Samples&>(*row);
      static_cast<MeasuredCosts&>(combination.row) = static_cast<const MeasuredCosts&>(*row);
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

/// The round with which this run began to measure, and the time of its start.
struct FirstRound {
  int number = 0;
  Clock::time_point start = Clock::now();
};

/// Reports the next sample. `rounds`: rounds before it, plus the finished share of its own.
void tell_sample(const ResultRow& row, double rounds, const FirstRound& first, const SceneJob& job,
                 const BenchWatch& watch) {
  std::string activity = fmt::format("round {}", static_cast<int>(rounds) + 1);
  const int planned = job.rounds - first.number;  // none if this sample's time does not count
  double done = planned > 0 ? (rounds - first.number) / planned : 0;
  if (job.deadline) {
    const std::chrono::duration<double> spent = Clock::now() - first.start, all = *job.deadline - first.start;
    done = all > spent ? std::max(done, spent / all) : 1;
  } else {
    activity += fmt::format("/{}", job.rounds);
  }
  watch.progress(activity + ": " + row.integrator + ' ' + row.backend,
                 job.preparation + (1 - job.preparation) * done);
}

/// Where the samples of a round start.
struct RoundStart {
  const State& state;
  /// The first node to examine, if the ends of the samples are checked.
  std::optional<std::size_t> first_node = {};
};

/// Chooses where samples start and which are checked. Programs cannot predict this: every sample makes the
/// same requests, and the check comes after the last sample.
class SampleSecrets {
 public:
  /// Chooses the round to check among the possible ones. `start`: of all samples, if their ends are not
  /// checked; must outlive this. `end`: with a deadline, the latest end of the last round.
  SampleSecrets(const SceneJob& job, const State& start, const FirstRound& first, Clock::time_point end)
      : job_(job), start_(start), checks_(!job.garment && !job.windowed && !job.verified) {
    if (job_.deadline)
      checked_from_ =
          first.start + std::chrono::duration_cast<Clock::duration>(between_0_and_1() * (end - first.start));
    else
      checked_round_ = first.number + static_cast<int>(between_0_and_1() * (job_.rounds - first.number));
  }

  /// Begins a round. It is checked if it has been chosen, or if it `must` be.
  RoundStart begin_round(int round, bool must) {
    if (!checks_) return {start_};
    const auto wave = static_cast<std::uint32_t>(random_());
    of_round_ = sample_start(*job_.system, wave);
    const bool is_chosen =
        !checked_ && (job_.deadline ? Clock::now() >= checked_from_ : round == checked_round_);
    if (!is_chosen && !must) return {of_round_};
    checked_ = wave;
    return {of_round_, first_};
  }

  /// Begins frames, of which every row's are checked if samples are: at the start of the checked round.
  RoundStart begin_frames() {
    if (!checked_) return {start_};
    of_round_ = sample_start(*job_.system, *checked_);
    return {of_round_, first_};
  }

  /// Whether a round is still to be checked.
  bool is_due() const { return checks_ && !checked_; }

  /// Compares the ends of the checked samples. The backends have been ended before.
  void compare(std::vector<Combination>& combinations) const {
    if (!checked_) return;
    const State start = sample_start(*job_.system, *checked_);
    for_each_integrator(job_, 1, [&](std::size_t i, std::size_t /*part*/) {
      std::vector<Combination*> checked;
      std::vector<SampleEnd> ends;
      for (Combination& combination : combinations)
        if (combination.integrator == job_.integrators[i] && combination.row.status == "ok")
          for (SampleEnd& end : std::exchange(combination.checked, {})) {
            checked.push_back(&combination);
            ends.push_back(std::move(end));
          }
      const std::vector<std::string> reasons =
          check_samples(*job_.system, *job_.integrators[i], job_.dt_s, start, first_, ends);
      for (std::size_t j = 0; j < reasons.size(); ++j)
        if (!reasons[j].empty()) fail(*checked[j], "failed: " + reasons[j]);
    });
  }

 private:
  double between_0_and_1() { return static_cast<double>(random_()) / 0x1p32; }

  const SceneJob& job_;
  const State& start_;
  const bool checks_;
  std::mt19937 random_{std::random_device{}()};
  const std::size_t first_ = random_();
  State of_round_;
  int checked_round_ = 0;
  Clock::time_point checked_from_;
  std::optional<std::uint32_t> checked_;  ///< wave number of the checked round
};

/// Longest time that SampleSecrets::compare probably takes after samples as long as the combinations' are
/// now: none if references have no time per step.
Clock::duration expected_check(const SceneJob& job, const std::vector<Combination>& combinations,
                               const std::vector<AfterReference>& references) {
  constexpr double both_references = 2.5;  // with rounding the state of one, in steps of the first reference
  double all = 0, longest = 0;
  for (std::size_t i = 0; i < job.integrators.size(); ++i) {
    int steps = 0;
    for (const Combination& combination : combinations)
      if (combination.integrator == job.integrators[i] && combination.backend)
        steps = std::max(steps, job.fps ? combination.most_steps : combination.steps);
    const double seconds = both_references * steps * references[i].step_seconds;
    all += seconds;
    longest = std::max(longest, seconds);
  }
  const double at_once = static_cast<double>(references_at_once(job));
  return std::chrono::duration_cast<Clock::duration>(
      std::chrono::duration<double>(std::max(longest, all / at_once)));
}

/// Expected time of the frames of all combinations.
Clock::duration expected_frames(const SceneJob& job, const std::vector<Combination>& combinations) {
  if (!job.fps) return {};
  const int steps = steps_of_frame(*job.fps, job.dt_s);
  double seconds = 0;
  for (const Combination& combination : combinations)
    if (combination.backend && steps <= combination.most_steps)  // time_frames times no longer ones
      seconds += combination.step_seconds * timed_frames * steps;
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

/// Takes one sample of every combination, in this order, from `start`. Returns false and discards the round
/// if stopped.
bool take_round(std::vector<Combination>& combinations, const std::vector<std::size_t>& order, int round,
                const FirstRound& first, const SceneJob& job, const RoundStart& start, bool kept,
                const BenchWatch& watch) {
  for (Combination& combination : combinations) combination.start = &start.state;
  std::vector<std::pair<Combination*, std::optional<double>>> samples;
  for (std::size_t place = 0; place < order.size(); ++place) {
    const std::size_t i = order[place];
    if (!combinations[i].backend) continue;
    if (watch.stop()) return false;
    tell_sample(combinations[i].row, round + static_cast<double>(place) / static_cast<double>(order.size()),
                first, job, watch);
    samples.emplace_back(&combinations[i], sample_ms(combinations[i], job, start.first_node));
  }
  for (const auto& [combination, ms] : samples) {
    if (!ms || !kept) continue;
    combination->row.samples_ms.push_back(*ms);
    combination->row.sample_steps.push_back(combination->steps);
  }
  return true;
}

}  // namespace

std::vector<ResultRow> bench_scene(const SceneJob& job, const BenchWatch& watch) {
  const auto total = static_cast<double>(job.integrators.size() * job.backends.size());
  std::vector<Combination> all;
  const auto done = [&] { return job.preparation * static_cast<double>(all.size()) / total; };
  std::optional<State> draped;
  if (job.garment && std::ranges::any_of(job.integrators, [](const Integrator* i) { return dresses(*i); })) {
    watch.progress("drape", 0);
    draped = draped_state(job, watch.stop);
    if (!draped) return {};
  }
  const State& start = draped ? *draped : job.system->start;
  if (!job.verified) watch.progress("references", 0);
  if (watch.stop()) return {};
  std::vector<AfterReference> references = run_references(job, start);
  for (std::size_t i = 0; i < job.integrators.size(); ++i) {
    const Integrator* integrator = job.integrators[i];
    for (const BackendInfo* info : job.backends) {
      watch.progress((job.verified ? "prepare: " : "verify: ") + std::string(integrator->name) + " " +
                         std::string(info->name),
                     done());
      if (watch.stop()) return {};
      std::optional<Combination>& serial = references[i].serial;
      const bool is_judged = serial && info->name == serial->row.backend;
      Combination& combination = all.emplace_back(
          is_judged ? std::move(*serial)
                    : make_unjudged(job, *info, *integrator, start, references[i].most_steps));
      if (!is_judged) judge(combination, job, *info, references[i]);
      if (combination.backend && job.garment && !job.verified) {
        watch.progress("dress with " + std::string(info->name), done());
        if (!dress_combination(combination, job, *info, watch.stop)) return {};
      }
      if (combination.backend) calibrate(combination, job);
    }
  }
  measure_peaks(job, all, watch);

  std::vector<std::size_t> order(all.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::mt19937 random(20160101);  // any fixed seed: a run can be repeated
  const Clock::duration after_rounds = expected_check(job, all, references) + expected_frames(job, all);
  const auto rounds_end = [&] { return job.deadline.value_or(Clock::time_point::max()) - after_rounds; };
  const FirstRound first{restore(all, job.earlier)};
  SampleSecrets secrets(job, start, first, rounds_end());
  const auto take = [&](int round, bool kept) {
    return take_round(all, order, round, first, job, secrets.begin_round(round, !kept), kept, watch);
  };
  bool stopped = false, measured_any = false;
  for (int round = 0; round < job.rounds; ++round) {
    std::ranges::shuffle(order, random);
    if (round < first.number) continue;
    const int measured = round - first.number;
    if (measured > 0 && Clock::now() + (Clock::now() - first.start) / measured > rounds_end()) break;
    if (!take(round, true)) {
      if (round == 0) return {};
      stopped = true;
      break;
    }
    watch.after_round(rows_of(all, false));
    measured_any = true;
  }
  // The deadline allowed fewer rounds than expected, or an earlier run took all of them: take one more, whose
  // times do not count.
  if (!stopped && (!measured_any || secrets.is_due())) stopped = !take(job.rounds - 1, false);
  for (Combination& combination : all)
    if (combination.backend) require_prompt_steps(combination, job);
  const RoundStart of_frames = secrets.begin_frames();
  for (Combination& combination : all) {
    if (combination.backend && !stopped) count_events(combination, job);
    if (job.fps && combination.backend && !stopped) {
      watch.progress(fmt::format("frames: {} {}", combination.row.integrator, combination.row.backend), 1);
      combination.start = &of_frames.state;
      time_frames(combination, job, of_frames.first_node, watch.stop);
    }
    end(combination);
  }
  watch.progress("check of the samples", 1);
  secrets.compare(all);
  return rows_of(all, !stopped);
}

}  // namespace mssim
