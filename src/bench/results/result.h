#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "text/text.h"

namespace mssim {

/// The backend that the others are compared with (speedup_vs_serial): the one marked BackendRole::baseline.
inline constexpr std::string_view baseline_name = "serial";

/// A row of the TABLE of backends that the page of `mssim web` measures in a browser.
struct BrowserBackend {
  std::string_view name;
  std::string_view paper_configuration;  ///< as BackendInfo::paper_configuration
};
inline constexpr auto browser_backends = std::to_array<BrowserBackend>({
    {"javascript", "cpu-only"},
    {"wasm", "cpu-only"},
    {"wasm-threads", "multi-thread-cpu"},
    {"webgpu", "gpu"},
});
/// Whether the page measures a backend of this name.
constexpr bool is_browser_backend(std::string_view name) {
  return std::ranges::find(browser_backends, name, &BrowserBackend::name) != browser_backends.end();
}
/// What `serial` is to the others, in a browser.
inline constexpr std::string_view browser_baseline_name = browser_backends[0].name;

/// Whether other backends are compared with this one.
inline bool is_baseline(std::string_view backend) {
  return backend == baseline_name || backend == browser_baseline_name;
}

/// Suffix, before a number of threads, of the names of rows that step one body after the other.
inline constexpr std::string_view each_suffix = ":each";

/// A measure of how a dressed garment fits.
struct FitNumberRecord {
  std::string name;             ///< ends in its unit
  std::optional<double> value;  ///< none if it is not finite
  std::optional<bool> within;   ///< whether it is within its bound; none without a bound
};

/// How a backend dressed a garment, from the start until it had settled.
struct DressingRecord {
  std::uint64_t iterations = 0;            ///< steps
  std::optional<std::uint64_t> seamed_at;  ///< steps after which all seams were closed
  bool settled = false;
  double simulated_s = 0;
  double wall_s = 0;
  std::vector<FitNumberRecord> fit;
};

/// What of the dressing is out of bounds, each a sentence without full stop.
inline std::vector<std::string> out_of_bounds(const DressingRecord& dressing) {
  std::vector<std::string> sentences;
  if (!dressing.seamed_at) sentences.emplace_back("its seams have not closed");
  if (!dressing.settled) sentences.emplace_back("it has not settled");
  for (const FitNumberRecord& number : dressing.fit)
    if (number.within == false)
      sentences.push_back(number.name + " is " + (number.value ? three_digits(*number.value) : "not finite"));
  return sentences;
}

/// What is measured: a scene, a backend and an integrator, by their names.
struct CombinationNames {
  std::string scene, backend, integrator;
};

inline bool same_combination(const CombinationNames& a, const CombinationNames& b) {
  return a.scene == b.scene && a.backend == b.backend && a.integrator == b.integrator;
}

/// The first row of this combination; null if there is none.
template <class Rows>
auto find_combination(Rows& rows, const CombinationNames& names) {
  const auto found = std::ranges::find_if(
      rows, [&](const CombinationNames& other) { return same_combination(other, names); });
  return found == rows.end() ? nullptr : &*found;
}

/// "scene, backend, integrator", for messages; names from a file may hold any characters.
inline std::string combination_name(const CombinationNames& names) {
  return printable(names.scene + ", " + names.backend + ", " + names.integrator, 300);
}

/// Difference between a row's state and the reference's after the verification's steps.
struct Agreement {
  std::optional<double> position_error, energy_drift;
  std::optional<std::uint64_t> state_hash;  ///< model/system.h; none from older versions of mssim
};

/// Costs of a row's steps other than time; medians of the samples.
struct MeasuredCosts {
  std::optional<double> processors_used, joules_per_step, cycles_per_step, instructions_per_step,
      cache_misses_per_step;
  // For processes that step together (Communication).
  std::optional<double> waiting_share, packing_share, bytes_per_step, messages_per_step, latency_us,
      link_gigabytes_per_second;
};

/// Costs of a row before it is verified: of its set-up and its first step (MemoryPeak). Empty if they were
/// not measured.
struct PreparationCosts {
  std::optional<double> setup_s, compile_s, first_step_ms;
  std::optional<std::uint64_t> peak_memory_bytes;
};

/// Times of single frames, measured after the samples: percentiles. Empty without --fps.
struct FrameTimes {
  std::optional<std::uint64_t> frame_steps;
  std::optional<double> frame_p50_ms, frame_p95_ms, frame_p99_ms;
};

/// A row's samples.
struct Samples {
  std::vector<double> samples_ms;  ///< [rounds] ms per step, in the order of the rounds
  std::vector<int> sample_steps;   ///< [rounds] steps in each sample
};

/// Values that follow from a row's samples. Empty unless the row is ok.
struct SampleStatistics {
  std::optional<double> ms_per_step, ms_per_step_low, ms_per_step_high, ms_per_step_min;
  std::optional<double> springs_per_second, gigabytes_per_second, roofline_fraction;
  std::optional<double> speedup_vs_serial;
  int outliers = 0;
};

/// One combination of scene, backend and integrator, measured and verified: a row of timings.csv, whose
/// columns are described by result_columns. Missing values (a failed row's times, a time that was never
/// published) are empty.
struct ResultRow : CombinationNames,
                   Agreement,
                   MeasuredCosts,
                   PreparationCosts,
                   FrameTimes,
                   Samples,
                   SampleStatistics {
  /// Whether the scene is, to the byte, the one that mssim ships under its name; only such a scene can be a
  /// paper's. Not a column.
  bool scene_as_shipped = true;
  std::uint64_t nodes = 0, springs_unique = 0;
  std::optional<std::uint64_t> springs_published;
  std::string device;
  int threads = 0;
  double dt_s = 0;
  int rounds = 0;
  std::optional<double> paper_ms;
  bool verified = false;
  std::string status = "ok", note;
  int warm_up_trials = 0;

  // Written to files of their own, like the samples.
  std::string program_output;              ///< last output of the backend's program, if there is one
  std::optional<DressingRecord> dressing;  ///< of garments only
};

/// A column of timings.csv.
struct ResultColumn {
  std::string_view name;     ///< ends in its unit, except for shares and counts
  std::string_view unit;     ///< empty: none
  std::string_view meaning;  ///< a sentence without its full stop, in Markdown
  std::variant<std::string ResultRow::*, bool ResultRow::*, int ResultRow::*, std::uint64_t ResultRow::*,
               std::optional<std::uint64_t> ResultRow::*, double ResultRow::*,
               std::optional<double> ResultRow::*>
      value;
  bool is_hash = false;  ///< 16 hexadecimal digits
};

/// The TABLE of columns, in their order. Readers rely on the order: append new ones. docs/bench.md repeats
/// it.
inline constexpr auto result_columns = std::to_array<ResultColumn>({
    {"scene", "", "the scene's name", &ResultRow::scene},
    {"nodes", "", "its nodes", &ResultRow::nodes},
    {"springs_unique", "", "its springs, each counted once", &ResultRow::springs_unique},
    {"springs_published", "", "its springs as Hong et al. count them", &ResultRow::springs_published},
    {"backend", "", "the backend's name", &ResultRow::backend},
    {"device", "", "`cpu`, with its instruction set, or an OpenCL device", &ResultRow::device},
    {"threads", "", "threads that compute a step; of a discrete device 1, the thread that waits for it",
     &ResultRow::threads},
    {"integrator", "", "the integrator's name", &ResultRow::integrator},
    {"dt_s", "s", "time step", &ResultRow::dt_s},
    {"rounds", "", "samples taken", &ResultRow::rounds},
    {"ms_per_step", "ms", "time per step, the median of the samples", &ResultRow::ms_per_step},
    {"ms_per_step_low", "ms",
     "lower end of the median's distribution-free 95 % interval; with fewer than six rounds the smallest "
     "sample",
     &ResultRow::ms_per_step_low},
    {"ms_per_step_high", "ms", "upper end of that interval, or the largest sample",
     &ResultRow::ms_per_step_high},
    {"ms_per_step_min", "ms", "the smallest sample", &ResultRow::ms_per_step_min},
    {"springs_per_second", "1/s", "unique springs times force evaluations", &ResultRow::springs_per_second},
    {"gigabytes_per_second", "GB/s", "the minimum bytes of a step, over the median time",
     &ResultRow::gigabytes_per_second},
    {"roofline_fraction", "",
     "the rate of the minimum bytes (or operations) of a step, over this machine's, measured in the same "
     "process",
     &ResultRow::roofline_fraction},
    {"speedup_vs_serial", "",
     "times as fast as `serial`, or as `javascript` in a browser: the median of the ratios within each "
     "round; "
     "empty without it",
     &ResultRow::speedup_vs_serial},
    {"paper_ms", "ms", "time published for this scene, integrator and configuration", &ResultRow::paper_ms},
    {"position_error", "",
     "largest distance of a node from the double-precision reference after 100 steps, in mean rest lengths; "
     "empty if nothing could be compared",
     &ResultRow::position_error},
    {"energy_drift", "",
     "total energy less the reference's, over the reference's kinetic plus elastic energy, or over a hundred "
     "times the elastic energy that rounding to single precision would cause, if that is more",
     &ResultRow::energy_drift},
    {"verified", "", "whether the steps agree with the reference, and the samples have the right end states",
     &ResultRow::verified},
    {"status", "",
     "`ok`, or `failed`, `unsupported`, `unavailable` or `not timed` (verified all the same) with the "
     "reason",
     &ResultRow::status},
    {"note", "", "remarks, for example that this TetGen made another mesh than the scene states",
     &ResultRow::note},
    {"warm_up_trials", "", "trials before the samples, until the backend was warm",
     &ResultRow::warm_up_trials},
    {"outliers", "", "samples beyond Tukey's fences, which count like others; `samples.csv` labels them",
     &ResultRow::outliers},
    {"state_hash", "", "hash of all positions and velocities after the verification's steps",
     &ResultRow::state_hash, true},
    {"processors_used", "",
     "processor time of the process that steps, over the wall-clock time, in the timed samples; the median",
     &ResultRow::processors_used},
    {"waiting_share", "",
     "share of a step's time in which a process waits for others; the mean of all processes",
     &ResultRow::waiting_share},
    {"packing_share", "", "share of a step's time in which a process packs and unpacks messages",
     &ResultRow::packing_share},
    {"bytes_per_step", "", "bytes that the process with most messages sends in a step",
     &ResultRow::bytes_per_step},
    {"messages_per_step", "", "messages that this process sends in a step", &ResultRow::messages_per_step},
    {"latency_us", "µs", "time of a message to a neighbour, measured before the first step",
     &ResultRow::latency_us},
    {"link_gigabytes_per_second", "GB/s", "rate of a large message to a neighbour, while another one comes",
     &ResultRow::link_gigabytes_per_second},
    {"setup_s", "s", "time to make the backend for the scene, once; of a program, to start and prepare it",
     &ResultRow::setup_s},
    {"compile_s", "s",
     "part of `setup_s` in which an OpenCL driver compiled; drivers keep kernels of earlier runs",
     &ResultRow::compile_s},
    {"first_step_ms", "ms", "time of the first step after that, once", &ResultRow::first_step_ms},
    {"peak_memory_bytes", "",
     "largest rise of this process's resident memory from before `setup_s` to after the first step; of a "
     "program, the peaks of its processes on this machine, added",
     &ResultRow::peak_memory_bytes},
    {"frame_steps", "", "steps of a frame, if `--fps` is given", &ResultRow::frame_steps},
    {"frame_p50_ms", "ms", "time that half of the frames do not exceed", &ResultRow::frame_p50_ms},
    {"frame_p95_ms", "ms", "time that 95 % of the frames do not exceed", &ResultRow::frame_p95_ms},
    {"frame_p99_ms", "ms", "time that 99 % of the frames do not exceed", &ResultRow::frame_p99_ms},
    {"joules_per_step", "J",
     "energy that the processors' packages used in the timed samples, whoever used them; the median",
     &ResultRow::joules_per_step},
    {"cycles_per_step", "", "processor cycles in user code of mssim's threads, in a sample that is not timed",
     &ResultRow::cycles_per_step},
    {"instructions_per_step", "", "instructions in that sample", &ResultRow::instructions_per_step},
    {"cache_misses_per_step", "", "cache misses in that sample; which cache it is depends on the processor",
     &ResultRow::cache_misses_per_step},
});

/// Bounds of a time, ms. Within them, statistics of times, their ratios and rates are finite.
inline constexpr double shortest_ms = 1e-12, longest_ms = 1e12;

/// Whether this can be a time in ms, or a ratio of two.
constexpr bool is_time(double ms) { return ms >= shortest_ms && ms <= longest_ms; }

/// What a number is for which is_time() is false, for the end of a sentence.
inline constexpr std::string_view not_a_time = "not between 1e-12 and 1e12";

/// A column of a time, or of a ratio of two.
struct TimeColumn {
  std::string_view name;
  std::optional<double> ResultRow::*value;
};
inline constexpr auto time_columns =
    std::to_array<TimeColumn>({{"ms_per_step", &ResultRow::ms_per_step},
                               {"ms_per_step_low", &ResultRow::ms_per_step_low},
                               {"ms_per_step_high", &ResultRow::ms_per_step_high},
                               {"ms_per_step_min", &ResultRow::ms_per_step_min},
                               {"speedup_vs_serial", &ResultRow::speedup_vs_serial}});

/// Whether so many samples have a 95 % interval (statistics.h).
bool has_interval(std::size_t samples);

/// Whether ms_per_step_low and ms_per_step_high are there, and are a 95 % interval.
inline bool has_interval(const ResultRow& row) {
  return row.ms_per_step_low && row.ms_per_step_high && has_interval(static_cast<std::size_t>(row.rounds));
}

/// Whether the row is ok and verified, so that its time counts.
inline bool counts(const ResultRow& row) { return row.status == "ok" && row.verified; }

/// Note of a row whose run has not ended, or ended before the checks that follow its last round.
inline constexpr std::string_view unchecked_samples = "its samples are not checked yet";

/// Note of a row of bench --verified, which has neither trials nor a check of its samples.
inline constexpr std::string_view verified_before = "verified by an earlier process";

/// Whether the checks that follow the last round are still to be made.
inline bool has_unchecked_samples(const ResultRow& row) {
  return row.note.find(unchecked_samples) != std::string::npos;
}

/// "the samples of 2 rows are not checked, because ...", with the remedy; empty if those of all rows that
/// count are.
std::string about_unchecked_samples(std::span<const ResultRow> rows);

/// Whether the row failed, or has a time that was not verified.
inline bool is_wrong(const ResultRow& row) {
  return row.status.starts_with("failed") || (row.status == "ok" && !row.verified);
}

/// Computes all values that follow from the row's samples. `serial`: the baseline's row of the same
/// integrator, or null.
void summarise(ResultRow& row, const ResultRow* serial);

/// Largest number of a result. What is computed from it, such as a percentage, is finite as well.
inline constexpr double largest_number = 1e300;

/// Removes numbers from the row that are not finite or larger than that. They arise if a program reports such
/// numbers, or takes less time than the clock resolves. The first one makes a row fail that was ok.
void require_finite(ResultRow& row);

/// Whether its steps took more processors than the `threads` that were requested. An OpenCL device does so if
/// its driver cannot divide it.
inline bool exceeds(const ResultRow& row, int threads) { return row.threads > threads; }

/// The row's status; a measured row that is not verified has failed.
inline std::string status_of(const ResultRow& row) {
  return row.status == "ok" && !row.verified ? "failed: not verified" : row.status;
}

}  // namespace mssim
