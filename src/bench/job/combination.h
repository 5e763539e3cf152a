#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "backends/backends.h"
#include "bench/job/scene_job.h"
#include "bench/results/result.h"
#include "bench/verification/sample_check.h"
#include "bench/verification/verification.h"

namespace mssim {

/// A row under way: a backend with an integrator on the job's scene.
struct Combination {
  ResultRow row;
  const Integrator* integrator = nullptr;
  bool on_host = true;
  int steps_per_pass = 0;
  std::optional<std::uint64_t> stored_springs;
  const State* start = nullptr;         ///< of every sample of a round
  std::unique_ptr<Backend> backend;     ///< null where the row has no times: it cannot run, or has failed
  DressingBackend* dressing = nullptr;  ///< the same, of a garment
  WindowBackend* windows = nullptr;     ///< the same, of a cloth that is seen in windows
  int steps = 1;                        ///< in a sample
  int most_steps = max_sample_steps;    ///< in a sample, so that its end can be compared with the reference
  std::vector<double> processors;       ///< that each sample of this run took: processor seconds a second
  std::vector<Communication> communication;  ///< in each sample of this run, where the backend tells it
  double step_seconds = 0;                   ///< what calibrate has found; 0 before
  std::vector<double> sample_seconds,
      reading_seconds;               ///< of this run: of samples, and of reading their ends
  double step_reading_seconds = 0;   ///< what reading the state takes after one step
  std::optional<SampleEnd> checked;  ///< the end of the sample that is to be checked
  /// What the windows say after so many steps, of a cloth that is seen in windows; empty where it was
  /// verified by an earlier process.
  std::function<Verification(WindowBackend& backend, int steps)> compare_windows;
};

/// Makes the backend; a reason not to becomes the row's status. `start`: of its samples; must
/// outlive it.
Combination make_combination(const SceneJob& job, const BackendInfo& info, const Integrator& integrator,
                             const State& start);

/// Ends the combination with a reason, and keeps what a program behind it wrote.
void fail(Combination& combination, const std::string& status);

/// Ends the backend of a combination that is measured, and keeps what it has come to say on the way and what
/// a program behind it wrote.
void end(Combination& combination);

/// Where the backend's times would mean nothing: ends it, and the row says why. Verified it stays.
void leave_untimed(Combination& combination);

/// Does something with the combination's backend; the row has failed where the program behind it fails.
void attempt(Combination& combination, const std::function<void()>& work);

/// Takes what a comparison with the reference has found. The row has failed where it is not near enough.
void take_verification(Combination& combination, const Verification& verification);

/// Takes over what an earlier process has found, and notes it in the row. The row has failed where it had
/// failed there, or where what was verified there is not what runs here.
void take_verification(Combination& combination, const std::vector<ResultRow>& verified);

/// Finds how many steps fill a sample, from ever longer trials, and goes on until the backend is warm. With
/// job.verified the first trial of a tenth of a sample decides, and the first samples warm the backend up:
/// the processes that are only sampled are many and short, and each counts with its least sample. The backend
/// rests afterwards.
void calibrate(Combination& combination, const SceneJob& job);

/// Milliseconds a step, in a sample of combination.steps from their start. Sets and warms up what is
/// needed outside the timed region, after which the backend rests. The row has failed where the result is not
/// finite, and where the program behind the backend fails: then there is no sample.
/// `first`: where the sample's end is to be checked, the node to look at first (sample_end).
std::optional<double> sample_ms(Combination& combination, const SceneJob& job,
                                std::optional<std::size_t> first);

/// Fails the combination where its samples show that steps are not taken while the clock runs, but when the
/// state is asked for: reading it then takes the longer, the more steps there were.
void require_prompt_steps(Combination& combination);

/// Computes all that follows from the row's samples. `serial`: the baseline's row of the same integrator, or
/// null.
void summarise(ResultRow& row, const ResultRow* serial);

/// Takes numbers that are not finite out of the row, as a program may have told some that lead to them or
/// have taken no time that a clock sees. A row that was ok has failed by the first of them.
void require_finite(ResultRow& row);

/// Adds to the row what the samples of this run took beside time: processors, and communication.
void summarise_costs(const Combination& combination, ResultRow& row);

}  // namespace mssim
