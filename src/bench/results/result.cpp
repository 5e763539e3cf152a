#include "bench/results/result.h"

#include <array>

namespace mssim {

std::span<const ResultColumn> result_columns() {
  using Row = ResultRow;
  static constexpr std::array<ResultColumn, 34> columns{{
      {"scene", "", "the scene's name", &Row::scene},
      {"nodes", "", "its nodes", &Row::nodes},
      {"springs_unique", "", "its springs, each counted once", &Row::springs_unique},
      {"springs_published", "", "its springs as Hong et al. count them", &Row::springs_published},
      {"backend", "", "the backend's name", &Row::backend},
      {"device", "", "what it ran on: `cpu`, with its instruction set, or an OpenCL device", &Row::device},
      {"threads", "", "processors that compute a step", &Row::threads},
      {"integrator", "", "the integrator's name", &Row::integrator},
      {"dt_s", "s", "time step", &Row::dt_s},
      {"rounds", "", "samples taken", &Row::rounds},
      {"ms_per_step", "ms", "time of a step, the median of the samples", &Row::ms_per_step},
      {"ms_per_step_low", "ms",
       "lower end of the median's distribution-free 95 % interval; with fewer than six rounds the smallest "
       "sample",
       &Row::ms_per_step_low},
      {"ms_per_step_high", "ms", "upper end of that interval, or the largest sample", &Row::ms_per_step_high},
      {"ms_per_step_min", "ms", "the smallest sample", &Row::ms_per_step_min},
      {"springs_per_second", "1/s", "unique springs times force evaluations", &Row::springs_per_second},
      {"gigabytes_per_second", "GB/s", "the minimum bytes of a step, over the median time",
       &Row::gigabytes_per_second},
      {"roofline_fraction", "",
       "the rate of the minimum bytes (or operations) of a step, over this machine's, measured in the same "
       "process",
       &Row::roofline_fraction},
      {"speedup_vs_serial", "",
       "times as fast as `serial`: the median of the ratios within each round; empty without `serial`",
       &Row::speedup_vs_serial},
      {"paper_ms", "ms", "time published for this scene, integrator and configuration", &Row::paper_ms},
      {"position_error", "",
       "largest distance of a node from the double-precision reference after 100 steps, in mean rest lengths",
       &Row::position_error},
      {"energy_drift", "",
       "total energy less the reference's, over the reference's kinetic plus elastic energy; of a scene at "
       "rest, over a hundred times the energy of what is rounded",
       &Row::energy_drift},
      {"verified", "", "whether the steps agree with the reference, and the samples ended where they should",
       &Row::verified},
      {"status", "",
       "`ok`, or `failed`, `unsupported`, `unavailable` or `not timed` (verified all the same) with the "
       "reason",
       &Row::status},
      {"note", "",
       "what a reader should know, for example that this TetGen made another mesh than the scene states",
       &Row::note},
      {"warm_up_trials", "", "trials before the samples, until the backend was warm", &Row::warm_up_trials},
      {"outliers", "", "samples beyond Tukey's fences, which count like others; `samples.csv` labels them",
       &Row::outliers},
      {"state_hash", "", "hash of all positions and velocities after the verification's steps",
       &Row::state_hash, true},
      {"processors_used", "",
       "processor time of the process that steps, over the wall-clock time, in the timed samples; the median",
       &Row::processors_used},
      {"waiting_share", "",
       "share of a step's time in which a process waits for others; the mean of all processes",
       &Row::waiting_share},
      {"packing_share", "", "share of a step's time in which a process packs and unpacks messages",
       &Row::packing_share},
      {"bytes_per_step", "", "bytes that the process with most messages sends in a step",
       &Row::bytes_per_step},
      {"messages_per_step", "", "messages that this process sends in a step", &Row::messages_per_step},
      {"latency_us", "µs", "time of a message to a neighbour, measured before the first step",
       &Row::latency_us},
      {"link_gigabytes_per_second", "GB/s", "rate of a large message to a neighbour, while another one comes",
       &Row::link_gigabytes_per_second},
  }};
  return columns;
}

}  // namespace mssim
