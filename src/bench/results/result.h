#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace mssim {

/// A number that says how a dressed garment fits.
struct FitNumberRecord {
  std::string name;             ///< ends in its unit
  std::optional<double> value;  ///< none where it is not finite
  std::optional<bool> within;   ///< what it must keep; none where it need not keep anything
};

/// How a backend dressed a garment once, from the start until it had settled.
struct DressingRecord {
  std::uint64_t iterations = 0;            ///< steps
  std::optional<std::uint64_t> seamed_at;  ///< steps after which all seams were closed
  bool settled = false;
  double simulated_s = 0;
  double wall_s = 0;
  std::vector<FitNumberRecord> fit;
};

/// One combination of scene, backend and integrator, measured and verified: a row of timings.csv.
/// Values that do not exist (a failed row's times, a paper time that was never published) are empty.
struct ResultRow {
  std::string scene;
  std::uint64_t nodes = 0;
  std::uint64_t springs_unique = 0;
  std::optional<std::uint64_t> springs_published;  ///< as Hong et al. count them
  std::string backend;
  std::string device;
  int threads = 0;  ///< processors that compute a step
  std::string integrator;
  double dt_s = 0;
  int rounds = 0;                         ///< samples taken
  std::optional<double> ms_per_step;      ///< median
  std::optional<double> ms_per_step_low;  ///< 95 % interval of the median
  std::optional<double> ms_per_step_high;
  std::optional<double> ms_per_step_min;
  std::optional<double> springs_per_second;    ///< unique springs times force evaluations
  std::optional<double> gigabytes_per_second;  ///< bytes that the step must move at least, over the median
  std::optional<double>
      roofline_fraction;  ///< of the peak that bounds the step, measured in the same process
  std::optional<double> speedup_vs_serial;  ///< median of the per-round ratios
  std::optional<double> paper_ms;           ///< published for this scene, integrator and configuration
  std::optional<double>
      position_error;  ///< largest distance to the double reference over the mean rest length
  std::optional<double>
      energy_drift;  ///< difference of total energy to the reference over the energy in motion
  /// Hash of the state after the verification's steps (model/system.h): rows with the same hash are the same
  /// to the last bit. None where an older mssim did not tell.
  std::optional<std::uint64_t> state_hash;
  bool verified = false;
  std::string status = "ok";  ///< ok, or failed/unsupported/unavailable/not timed, and why after a colon
  std::string note;           ///< what a reader of the numbers should know, or empty
  int warm_up_trials = 0;     ///< before the samples, until the backend was warm
  int outliers = 0;  ///< samples that lie far from the rest (statistics/statistics.h); they count too
  std::optional<double> processors_used;  ///< processor seconds a second of the samples, median
  // Of processes that take the steps together, medians of the samples (Communication).
  std::optional<double> waiting_share;   ///< of a step, in which a process waits for others; mean of all
  std::optional<double> packing_share;   ///< of a step, in which it packs and unpacks messages
  std::optional<double> bytes_per_step;  ///< that the process with most sends
  std::optional<double> messages_per_step;
  std::optional<double> latency_us;  ///< of a message to a neighbour
  std::optional<double> link_gigabytes_per_second;
  std::string program_output;      ///< what the program behind the backend wrote last, where there is one
  std::vector<double> samples_ms;  ///< [rounds] ms per step, in the order of the rounds
  std::vector<int> sample_steps;   ///< [rounds] steps in each sample
  std::optional<DressingRecord> dressing;  ///< of a garment
};

/// What is measured of a row or computed from it, by the names of their columns.
inline constexpr std::array<std::pair<std::string_view, std::optional<double> ResultRow::*>, 16> row_numbers{{
    {"position_error", &ResultRow::position_error},
    {"energy_drift", &ResultRow::energy_drift},
    {"ms_per_step", &ResultRow::ms_per_step},
    {"ms_per_step_low", &ResultRow::ms_per_step_low},
    {"ms_per_step_high", &ResultRow::ms_per_step_high},
    {"ms_per_step_min", &ResultRow::ms_per_step_min},
    {"springs_per_second", &ResultRow::springs_per_second},
    {"gigabytes_per_second", &ResultRow::gigabytes_per_second},
    {"roofline_fraction", &ResultRow::roofline_fraction},
    {"speedup_vs_serial", &ResultRow::speedup_vs_serial},
    {"processors_used", &ResultRow::processors_used},
    {"waiting_share", &ResultRow::waiting_share},
    {"packing_share", &ResultRow::packing_share},
    {"bytes_per_step", &ResultRow::bytes_per_step},
    {"latency_us", &ResultRow::latency_us},
    {"link_gigabytes_per_second", &ResultRow::link_gigabytes_per_second},
}};

/// Are these, whatever is known of them, of the same scene, backend and integrator?
template <class A, class B>
bool same_combination(const A& a, const B& b) {
  return a.scene == b.scene && a.backend == b.backend && a.integrator == b.integrator;
}

/// "scene, backend, integrator", for messages.
template <class A>
std::string combination_name(const A& a) {
  return a.scene + ", " + a.backend + ", " + a.integrator;
}

/// Is this the time of something that works?
inline bool counts(const ResultRow& row) { return row.status == "ok" && row.verified; }

/// Did its steps take more processors than these threads, which were asked for? So does a device that its
/// driver cannot divide.
inline bool exceeds(const ResultRow& row, int threads) { return row.threads > threads; }

/// The row's status; a row that was measured but not verified has failed.
inline std::string status_of(const ResultRow& row) {
  return row.status == "ok" && !row.verified ? "failed: not verified" : row.status;
}

}  // namespace mssim
