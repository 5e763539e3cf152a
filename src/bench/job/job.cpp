#include "bench/job/job.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <random>
#include <utility>

#include "backends/devices/drivers.h"
#include "statistics/statistics.h"

namespace mssim {
namespace {

/// Steps that take this long (s) are timed without a warm-up step: waking threads takes about 50 us, and
/// filling the caches little more.
constexpr double long_step_s = 0.01;

/// No step takes less time (s): even a handful of nodes is more than tens of operations.
constexpr double least_step_s = 1e-8;

struct SampleTime {
  double wall_s = 0;
  double processor_s = 0;
  std::optional<double> joules = {};  ///< of the machine's processors
};

/// Returns to the state from which samples start.
void restart(Combination& combination) { combination.backend->set_state(*combination.start); }

/// The same, with threads awake and caches filled.
void warm_up(Combination& combination) {
  restart(combination);
  if (combination.step_seconds >= long_step_s) return;
  combination.backend->step(1);
  restart(combination);
}

template <class Work>
double seconds_of(const Work& work) {
  const Stopwatch watch;
  work();
  return watch.seconds();
}

/// Times the steps of one sample.
SampleTime time_sample(Combination& combination, int steps) {
  Backend& backend = *combination.backend;
  warm_up(combination);
  backend.communication();  // discards that of earlier steps
  combination.energy.joules();
  // Read last before the steps and first after them: reading the counters of energy takes CPU time.
  const double processor_before = backend.processor_seconds();
  // No clock resolves less than 1 ns.
  const double wall_s = std::max(1e-9, seconds_of([&] { backend.step(steps); }));
  const double processor_s = backend.processor_seconds() - processor_before;
  return {wall_s, processor_s, combination.energy.joules()};
}

/// Description of a row beyond its names.
std::string subject_of(const ResultRow& row) {
  return fmt::format("{} nodes and {} springs in steps of {:.6g} s on {} with {}", row.nodes,
                     row.springs_unique, row.dt_s, row.device, pluralize(row.threads, "thread"));
}

/// Ends a combination that is not measured further.
void drop(Combination& combination, const std::string& status) {
  combination.row.status = status;
  end(combination);
}

/// Readings of states from which on they decide whether steps were postponed: a busy machine delays single
/// ones.
constexpr std::size_t fewest_readings = 3;

/// Whether reading the states took longer than their steps (require_prompt_steps).
bool are_postponed(std::span<const double> step_seconds, std::span<const double> postponed_seconds) {
  return median_interval(postponed_seconds).low > median(step_seconds);
}

/// Smallest observable step of the steady clock among a thousand in a row, s.
double clock_resolution_s() {
  using Clock = std::chrono::steady_clock;
  Clock::duration smallest = Clock::duration::max();
  for (int i = 0; i < 1000; ++i) {
    const auto before = Clock::now();
    auto after = Clock::now();
    while (after == before) after = Clock::now();
    smallest = std::min(smallest, after - before);
  }
  return std::chrono::duration<double>(smallest).count();
}

void find_sample_steps(Combination& combination, const SceneJob& job) {
  static const double resolution_s = clock_resolution_s();
  const auto time_steps = [&](int steps) { return time_sample(combination, steps).wall_s; };
  int steps = 1;
  for (;;) {
    combination.step_seconds = time_steps(steps) / steps;
    if (combination.step_seconds < least_step_s)
      return fail(combination,
                  fmt::format("failed: it reports steps before they are done: {} take less than 10 ns each",
                              pluralize(steps, "step")));
    const int fit =
        sample_steps(combination.step_seconds, job.sample_seconds, resolution_s, combination.most_steps);
    if (fit <= (job.verified ? 10 : 2) * steps) {
      steps = fit;
      break;
    }
    steps = std::min(fit, 10 * steps);
  }
  if (steps > combination.most_steps)
    return drop(combination, fmt::format("not timed: {}, the most that can be compared with the reference, "
                                         "take less time than the clock can measure; use a larger scene",
                                         pluralize(combination.most_steps, "step")));
  if (job.verified) {
    combination.steps = steps;
    return;
  }
  // Each is part of a sample, because a warm backend needs three trials to prove it.
  const int trial_steps = std::max(1, steps / 4);
  std::vector<double> trials;
  while (trials.size() < most_warm_up_trials && !is_warm(trials)) trials.push_back(time_steps(trial_steps));
  combination.row.warm_up_trials = static_cast<int>(trials.size());
  combination.step_seconds = median(trials) / trial_steps;
  combination.steps =
      sample_steps(combination.step_seconds, job.sample_seconds, resolution_s, combination.most_steps);
}

}  // namespace

int sample_steps(double step_seconds, double sample_seconds, double clock_resolution_seconds, int most) {
  const double seconds = std::max(step_seconds, 1e-12);
  const double enough_for_clock = std::ceil(least_clock_steps * clock_resolution_seconds / seconds);
  const double limit = std::max<double>(most, enough_for_clock);
  return static_cast<int>(std::clamp(sample_seconds / seconds, 1.0, std::min(limit, 1e9)));
}

bool is_warm(std::span<const double> trial_seconds) {
  if (trial_seconds.size() < 3) return false;
  constexpr double faster = 0.98;
  const auto last_two = trial_seconds.last(2);
  const double fastest = *std::min_element(trial_seconds.begin(), trial_seconds.end() - 2);
  return *std::min_element(last_two.begin(), last_two.end()) >= faster * fastest;
}

void end(Combination& combination) {
  if (!combination.backend) return;
  ResultRow& row = combination.row;
  const std::string note = combination.backend->note();
  if (row.note.find(note) == std::string::npos) append_sentence(row.note, note);
  row.program_output = combination.backend->end();
  combination.backend.reset();
  combination.dressing = nullptr;
}

void fail(Combination& combination, const std::string& status) {
  combination.row.verified = false;
  static_cast<FrameTimes&>(combination.row) = {};
  drop(combination, status);
}

void attempt(Combination& combination, const std::function<void()>& work) {
  try {
    work();
  } catch (const BackendFailure& failure) {
    fail(combination, std::string("failed: ") + failure.what());
    combination.row.program_output = failure.output;
  }
}

Combination make_combination(const SceneJob& job, const BackendInfo& info, const Integrator& integrator,
                             const State& start) {
  Combination combination;
  combination.integrator = &integrator;
  combination.start = &start;
  combination.energy = PackageEnergy(job.root);
  ResultRow& row = combination.row;
  row.scene = job.execution.scene;
  row.nodes = job.windowed ? job.windowed->nodes() : job.system->nodes();
  row.springs_unique = job.windowed ? job.windowed->springs : job.system->springs.size();
  row.springs_published = job.springs_published;
  row.note = job.note;
  row.backend = info.name;
  row.integrator = integrator.name;
  row.dt_s = job.dt_s;
  const auto make = [&] {
    const MemoryPeak peak;
    const double compiled_before = compile_seconds();
    const Stopwatch watch;
    if (job.garment) {
      auto dressing = make_dressing_backend(info, *job.system, integrator, job.dt_s, job.execution);
      combination.dressing = dressing.get();
      combination.backend = std::move(dressing);
    } else if (job.windowed) {
      combination.backend =
          make_window_backend(info, *job.system, integrator, job.dt_s, job.execution, job.windowed->windows);
    } else {
      combination.backend = make_backend(info, *job.system, integrator, job.dt_s, job.execution);
    }
    row.setup_s = watch.seconds();
    if (const double compiled = compile_seconds() - compiled_before; compiled > 0) row.compile_s = compiled;
    row.device = combination.backend->device();
    row.threads = combination.backend->threads();
    append_sentence(row.note, combination.backend->note());
    append_sentence(row.note, excess_of(info, *combination.backend, job.execution));
    combination.in_single = !info.in_double && combination.backend->is_in_single();
    restart(combination);
    row.first_step_ms = 1000 * seconds_of([&] { combination.backend->step(1); });
    row.peak_memory_bytes = info.program ? combination.backend->program_peak_bytes() : peak.rise();
    combination.backend->rest();
  };
  try {
    attempt(combination, make);
  } catch (const Unavailable& reason) {
    fail(combination, std::string("unavailable: ") + reason.what());
  } catch (const Unsupported& reason) {
    fail(combination, std::string("unsupported: ") + reason.what());
  }
  return combination;
}

void take_verification(Combination& combination, const Verification& verification) {
  static_cast<Agreement&>(combination.row) = {verification.position_error, verification.energy_drift,
                                              verification.state_hash};
  combination.row.verified = !verification.failure;
  if (verification.failure) fail(combination, "failed: " + *verification.failure);
}

void take_verification(Combination& combination, const std::vector<ResultRow>& verified) {
  ResultRow& row = combination.row;
  const ResultRow* found = find_combination(verified, row);
  if (!found) return fail(combination, "failed: no earlier process has verified it");
  if (!found->verified) return fail(combination, status_of(*found));
  if (found->device != row.device || found->threads != row.threads || found->nodes != row.nodes ||
      found->springs_unique != row.springs_unique || found->dt_s != row.dt_s)
    return fail(combination,
                fmt::format("failed: {} was verified, but this is {}", subject_of(*found), subject_of(row)));
  static_cast<Agreement&>(row) = static_cast<const Agreement&>(*found);
  row.dressing = found->dressing;
  row.verified = true;
  append_sentence(row.note, verified_before);
  if (found->status != "ok") drop(combination, found->status);
}

void calibrate(Combination& combination, const SceneJob& job) {
  if (const std::string reason = combination.backend->reason_not_to_time(); !reason.empty())
    return drop(combination, "not timed: " + reason);
  attempt(combination, [&] {
    find_sample_steps(combination, job);
    if (!combination.backend) return;
    if (job.windowed)
      combination.steps = *std::prev(std::ranges::upper_bound(window_looks, combination.steps));
    combination.backend->rest();
  });
}

std::optional<double> sample_ms(Combination& combination, const SceneJob& job,
                                std::optional<std::size_t> first) {
  std::optional<double> ms;
  attempt(combination, [&] {
    const SampleTime time = time_sample(combination, combination.steps);
    if (const auto costs = combination.backend->communication()) combination.communication.push_back(*costs);
    const TimedState end = job.windowed ? TimedState{combination.backend->state()}
                                        : read_state(*combination.backend, *combination.start, time.wall_s);
    combination.postponed_seconds.push_back(end.postponed_s);
    combination.sample_seconds.push_back(time.wall_s);
    if (first_bad_node(end.state)) {
      const std::optional<BlowUp> blow_up =
          job.windowed ? find_blow_up(*combination.backend, *job.windowed, combination.steps)
                       : find_blow_up(*combination.backend, *combination.start, combination.steps);
      fail(combination, "failed: " + (blow_up ? describe(*blow_up, job.dt_s) + std::string(unless_alone)
                                              : std::string(finite_in_the_next)));
    } else {
      if (first) combination.checked = {sample_end(*job.system, end.state, combination.steps, *first)};
      combination.backend->rest();
      if (combination.compare_windows)
        if (const auto wrong =
                combination.compare_windows(*combination.backend, end.state, combination.steps).failure)
          fail(combination, "failed: " + *wrong);
    }
    combination.processors.push_back(time.processor_s / time.wall_s);
    if (time.joules) combination.joules.push_back(*time.joules / combination.steps);
    ms = 1000 * time.wall_s / combination.steps;
  });
  return ms;
}

void time_frames(Combination& combination, const SceneJob& job, std::optional<std::size_t> first,
                 const std::function<bool()>& stop) {
  const int steps = steps_of_frame(job.fps.value(), job.dt_s);
  // A window is compared after certain numbers of steps only.
  const auto is_compared = [&](int frames) {
    return !combination.compare_windows ||
           std::ranges::find(window_looks, frames * steps) != window_looks.end();
  };
  int at_a_stretch = combination.most_steps / steps;
  while (at_a_stretch > 0 && !is_compared(at_a_stretch)) --at_a_stretch;
  if (at_a_stretch == 0)
    return append_sentence(
        combination.row.note,
        fmt::format("{}: samples of this row end after {}{}", untimed_frames(steps),
                    pluralize(combination.most_steps, "step"),
                    combination.compare_windows ? ", or windows are not compared then" : ""));
  const std::string after = fmt::format(", in frames of {}", pluralize(steps, "step"));
  std::vector<double> frames_ms, stretch_seconds, postponed_seconds;
  std::optional<SampleEnd> checked;
  std::random_device random;
  attempt(combination, [&] {
    const auto is_enough = [&] { return frames_ms.size() >= timed_frames; };
    while (!is_enough() ||
           (stretch_seconds.size() < fewest_readings && are_postponed(stretch_seconds, postponed_seconds))) {
      restart(combination);
      combination.backend->step(1);  // wakes threads and caches up
      restart(combination);
      double seconds = 0;
      int frame = 0;
      for (; frame < at_a_stretch && (frame == 0 || !is_enough()); ++frame) {
        if (stop()) return;
        frames_ms.push_back(1000 * seconds_of([&] { combination.backend->step(steps); }));
        seconds += frames_ms.back() / 1000;
      }
      const TimedState end = job.windowed ? TimedState{combination.backend->state()}
                                          : read_state(*combination.backend, *combination.start, seconds);
      stretch_seconds.push_back(seconds);
      postponed_seconds.push_back(end.postponed_s);
      if (first_bad_node(end.state)) return fail(combination, "failed: not finite" + after);
      if (combination.compare_windows && is_compared(frame))  // the last stretch may be shorter
        if (const auto wrong =
                combination.compare_windows(*combination.backend, end.state, frame * steps).failure)
          return fail(combination, "failed: " + *wrong + after);
      if (first && random() % stretch_seconds.size() == 0)  // each is as likely to be the one in the end
        checked = sample_end(*job.system, end.state, frame * steps, *first);
    }
    if (are_postponed(stretch_seconds, postponed_seconds))
      return fail(combination, "failed: " +
                                   describe_postponed(steps, median(stretch_seconds),
                                                      median_interval(postponed_seconds).low) +
                                   after);
    combination.backend->rest();
    if (checked) combination.checked.push_back(std::move(*checked));
    static_cast<FrameTimes&>(combination.row) = {static_cast<std::uint64_t>(steps), quantile(frames_ms, 0.5),
                                                 quantile(frames_ms, 0.95), quantile(frames_ms, 0.99)};
  });
}

void count_events(Combination& combination, const SceneJob& job) {
  EventCounters counters(job.events);
  if (!counters.obstacle().empty() || !combination.backend->steps_in_process()) return;
  attempt(combination, [&] {
    warm_up(combination);
    counters.start();
    combination.backend->step(combination.steps);
    if (const auto events = counters.stop()) {
      MeasuredCosts& costs = combination.row;
      costs.cycles_per_step = (*events)[0] / combination.steps;
      costs.instructions_per_step = (*events)[1] / combination.steps;
      costs.cache_misses_per_step = (*events)[2] / combination.steps;
    }
    combination.backend->rest();
  });
}

void require_prompt_steps(Combination& combination, const SceneJob& job) {
  if (combination.steps == 1 || combination.sample_seconds.empty()) return;
  while (are_postponed(combination.sample_seconds, combination.postponed_seconds)) {
    if (combination.sample_seconds.size() >= fewest_readings)
      return fail(combination,
                  "failed: " + describe_postponed(combination.steps, median(combination.sample_seconds),
                                                  median_interval(combination.postponed_seconds).low));
    sample_ms(combination, job, std::nullopt);
    if (!combination.backend) return;
  }
}

void summarise_costs(const Combination& combination, ResultRow& row) {
  if (!combination.processors.empty()) row.processors_used = median(combination.processors);
  if (!combination.joules.empty()) row.joules_per_step = median(combination.joules);
  const auto summarise = [&](std::optional<double> Communication::*cost, std::optional<double>& column,
                             double unit) {
    std::vector<double> values;
    for (const Communication& sample : combination.communication)
      if (sample.*cost) values.push_back(*(sample.*cost));
    if (!values.empty()) column = unit * median(values);
  };
  summarise(&Communication::waiting, row.waiting_share, 1);
  summarise(&Communication::packing, row.packing_share, 1);
  summarise(&Communication::bytes, row.bytes_per_step, 1);
  summarise(&Communication::messages, row.messages_per_step, 1);
  summarise(&Communication::latency_s, row.latency_us, 1e6);
  summarise(&Communication::bytes_per_second, row.link_gigabytes_per_second, 1e-9);
}

}  // namespace mssim
