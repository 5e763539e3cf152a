#include "garment/bench/dressing_record.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "bench/verification/verification.h"
#include "garment/stepping/dressing_backend.h"
#include "integrators/all_integrators.h"
#include "text/text.h"

namespace mssim {
namespace {

DressingRecord record_of(const DressingResult& result, double wall_s) {
  DressingRecord record;
  record.iterations = static_cast<std::uint64_t>(result.iterations);
  if (result.seamed_at) record.seamed_at = static_cast<std::uint64_t>(*result.seamed_at);
  record.settled = result.settled;
  record.simulated_s = result.simulated_s;
  record.wall_s = wall_s;
  return record;
}

/// Keeps an earlier record of the same combination. Says whether there was one.
bool keep_earlier(ResultRow& row, const std::vector<ResultRow>& earlier) {
  const auto same =
      std::ranges::find_if(earlier, [&](const ResultRow& other) { return same_combination(other, row); });
  if (same == earlier.end() || !same->dressing || same->status != "ok") return false;
  row.dressing = same->dressing;
  return true;
}

}  // namespace

std::optional<State> draped_state(const SceneJob& job, const std::function<bool()>& stop) {
  const auto backend =
      make_openmp_dressing(*job.system, *find_integrator("semi-euler"), job.dt_s, job.execution.threads);
  bool stopped = false;
  DressingResult result = dress(*backend, *job.system, job.dt_s, job.garment->rule,
                                [&](const State&, std::int64_t) { return !(stopped = stop()); });
  if (stopped) return std::nullopt;
  result.state.draped = true;
  return std::move(result.state);
}

bool dress_combination(Combination& combination, const SceneJob& job, const std::function<bool()>& stop) {
  using Clock = std::chrono::steady_clock;
  ResultRow& row = combination.row;
  if (keep_earlier(row, job.earlier)) return true;
  bool stopped = false;
  std::optional<std::size_t> bad_node;
  const auto before = Clock::now();
  const DressingResult result = dress(*combination.dressing, *job.system, job.dt_s, job.garment->rule,
                                      [&](const State& state, std::int64_t) {
                                        stopped = stop();
                                        bad_node = first_bad_node(state);
                                        return !stopped && !bad_node;
                                      });
  if (stopped) return false;
  row.dressing = record_of(result, std::chrono::duration<double>(Clock::now() - before).count());
  if (bad_node) {
    fail(combination, "failed: the dressing blew up before step " + std::to_string(result.iterations) +
                          ": node " + std::to_string(*bad_node) + " is not finite");
    return true;
  }
  const Fit fit = fit_of(*job.system, result.state.position, job.garment->body);
  for (FitCheck& check : fit_checks(fit, job.garment->bounds))
    row.dressing->fit.push_back({std::move(check.name),
                                 std::isfinite(check.value) ? std::optional(check.value) : std::nullopt,
                                 check.within});
  const std::vector<std::string> found = misfits(result, fit, job.garment->bounds);
  if (!found.empty()) fail(combination, "failed: dressed, " + join(found, "; "));
  return true;
}

}  // namespace mssim
