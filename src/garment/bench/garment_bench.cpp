#include "garment/bench/garment_bench.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>

#include "garment/stepping/dressing_backend.h"
#include "integrators/all_integrators.h"
#include "model/system.h"
#include "statistics/statistics.h"
#include "text/text.h"

namespace mssim {
namespace {

static_assert(stretches * stretch_steps == verification_steps);

/// Adds a wave to the velocities of all nodes but the pinned ones.
void excite(const System& system, State& state) {
  constexpr double speed = 0.2;       // m/s
  constexpr double wavelength = 0.3;  // m
  constexpr double k = 2 * std::numbers::pi / wavelength;
  for (std::size_t i = 0; i < state.position.size(); ++i) {
    const Vec3d& x = state.position[i];
    state.velocity[i] += speed * Vec3d{std::sin(k * x.y), std::sin(k * x.z), std::sin(k * x.x)};
  }
  for (const std::uint32_t pin : system.pins) state.velocity[pin] = {};
}

/// Appends the stretches of the reference's trajectory from a start to `way`. Returns a reason if it blows
/// up.
std::optional<std::string> follow(Backend& reference, const System& system, const State& start, double dt_s,
                                  std::vector<GarmentStretch>& way) {
  reference.set_state(start);
  for (int i = 0; i < stretches; ++i) {
    way.push_back({reference.state(), {}});
    GarmentStretch& stretch = way.back();
    stretch.start.draped = start.draped;
    if (start.draped) excite(system, stretch.start);
    round_to_single(stretch.start);
    reference.step(stretch_steps);
  }
  for (GarmentStretch& stretch : way) {
    reference.set_state(stretch.start);
    reference.step(stretch_steps);
    stretch.end = reference.state();
    if (!first_bad_node(stretch.end)) continue;
    const auto blow_up = find_blow_up(reference, stretch.start, stretch_steps);
    const auto before = static_cast<int>(&stretch - way.data()) * stretch_steps;
    return "the double-precision reference " + describe(blow_up.value_or(BlowUp{}), dt_s, before);
  }
  return std::nullopt;
}

/// Errors of a backend over the stretches of one kind.
class StretchErrors {
 public:
  explicit StretchErrors(const System& system)
      : system_(system), unit_(mean_rest_length(system)), errors_(system.nodes()) {}

  /// Steps the backend over all stretches. Returns a reason if it blows up.
  std::optional<std::string> run(Backend& backend, const std::vector<GarmentStretch>& way, double dt_s) {
    for (const GarmentStretch& stretch : way) {
      backend.set_state(stretch.start);
      backend.step(stretch_steps);
      const State state = backend.state();
      if (first_bad_node(state)) {
        const auto blow_up = find_blow_up(backend, stretch.start, stretch_steps);
        return blow_up ? describe(*blow_up, dt_s) : std::string(finite_in_the_next);
      }
      last_hash = state_hash(state);
      for (std::size_t i = 0; i < errors_.size(); ++i)
        errors_[i].push_back(length(state.position[i] - stretch.end.position[i]) / unit_);
      const Energy expected = energy_of(system_, stretch.end);
      energy_error += energy_of(system_, state).total() - expected.total();
      energy_in_motion += expected.kinetic + expected.elastic;
    }
    return std::nullopt;
  }

  /// The largest over the nodes of a node's median over the stretches.
  double largest_median() const {
    double largest = 0;
    for (const std::vector<double>& of_node : errors_) largest = std::max(largest, median(of_node));
    return largest;
  }

  /// The quantile of the errors of all nodes in all stretches.
  double quantile(double fraction) const {
    std::vector<double> all;
    for (const std::vector<double>& of_node : errors_) all.insert(all.end(), of_node.begin(), of_node.end());
    return mssim::quantile(std::move(all), fraction);
  }

  double energy_error = 0, energy_in_motion = 0;  ///< J, sums over the stretches
  std::uint64_t last_hash = 0;                    ///< of the state after the last step

 private:
  const System& system_;
  double unit_;                              ///< m
  std::vector<std::vector<double>> errors_;  ///< [nodes][stretches] in mean rest lengths
};

/// Takes the record of an earlier row of the same combination; returns whether there was one.
bool keep_earlier(ResultRow& row, const std::vector<ResultRow>& earlier) {
  const ResultRow* same = find_combination(earlier, row);
  if (!same || !same->dressing || same->status != "ok") return false;
  row.dressing = same->dressing;
  return true;
}

/// Notes the numbers of a published algorithm's dressing that are out of bounds.
void note_misfit(ResultRow& row) {
  const std::vector<std::string> found = out_of_bounds(*row.dressing);
  if (!found.empty()) append_sentence(row.note, "as published it does not fit: " + join(found, ", "));
}

}  // namespace

GarmentReference run_garment_reference(Backend& backend, const System& system, const Integrator& integrator,
                                       double dt_s, const State& draped) {
  GarmentReference reference;
  reference.tolerance = position_tolerance(system, integrator, stretch_steps);
  reference.farthest = std::get<Garment>(system.topology).dressing.push_speed * stretch_steps * dt_s /
                       mean_rest_length(system);
  reference.failure = follow(backend, system, system.start, dt_s, reference.seaming);
  if (!reference.failure) reference.failure = follow(backend, system, draped, dt_s, reference.draped);
  return reference;
}

Verification verify_garment(Backend& backend, const System& system, const GarmentReference& reference,
                            double dt_s) {
  Verification result;
  StretchErrors seaming(system), draped(system);
  result.failure = reference.failure;
  if (!result.failure) result.failure = seaming.run(backend, reference.seaming, dt_s);
  if (!result.failure) result.failure = draped.run(backend, reference.draped, dt_s);
  if (result.failure) return result;

  const double of_node = seaming.largest_median();
  const double of_half = draped.quantile(0.5), of_most = draped.quantile(0.9), any = draped.quantile(1);
  result.state_hash = draped.last_hash;
  result.position_error = std::max(of_node, of_most);
  const double drift =
      (seaming.energy_error + draped.energy_error) / (seaming.energy_in_motion + draped.energy_in_motion);
  result.energy_drift = drift;
  const auto hold = [&](double error, double bound, std::string_view whose) {
    if (result.failure || error <= bound) return;
    result.failure = fmt::format("position error {:g} of a rest length{} exceeds {:g} after {} steps", error,
                                 whose, bound, stretch_steps);
  };
  hold(of_node, reference.tolerance, ", of one node while the seams close,");
  hold(of_half, reference.tolerance / 4, ", of half of the nodes when draped,");
  hold(of_most, reference.tolerance, ", of a tenth of the nodes when draped,");
  hold(any, reference.farthest, ", of one node when draped,");
  if (!result.failure && !(std::abs(drift) <= energy_tolerance))
    result.failure =
        fmt::format("energy is off by {:g} of kinetic plus elastic energy, more than {:g}, after {} steps",
                    drift, energy_tolerance, stretch_steps);
  return result;
}

std::optional<State> draped_state(const SceneJob& job, const std::function<bool()>& stop) {
  const auto backend = make_openmp_dressing(*job.system, *find_integrator("semi-euler"), job.dt_s,
                                            {.threads = job.execution.threads});
  bool stopped = false;
  DressingResult result = dress(*backend, *job.system, job.dt_s, job.garment->rule,
                                [&](const State&, std::int64_t) { return !(stopped = stop()); });
  if (stopped) return std::nullopt;
  result.state.draped = true;
  return std::move(result.state);
}

bool dress_combination(Combination& combination, const SceneJob& job, const BackendInfo& info,
                       const std::function<bool()>& stop) {
  using Clock = std::chrono::steady_clock;
  ResultRow& row = combination.row;
  const bool is_published = info.role == BackendRole::as_published;
  if (keep_earlier(row, job.earlier)) {
    if (is_published) note_misfit(row);
    return true;
  }
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
  row.dressing = DressingRecord{static_cast<std::uint64_t>(result.iterations),
                                result.seamed_at,
                                result.settled,
                                result.simulated_s,
                                std::chrono::duration<double>(Clock::now() - before).count(),
                                {}};
  if (bad_node) {
    fail(combination, fmt::format("failed: the dressing blew up before step {}: node {} is not finite",
                                  result.iterations, *bad_node));
    return true;
  }
  const Fit fit = fit_of(*job.system, result.state.position, job.garment->body);
  for (FitCheck& check : fit_checks(fit, job.garment->bounds))
    row.dressing->fit.push_back({std::move(check.name),
                                 std::isfinite(check.value) ? std::optional(check.value) : std::nullopt,
                                 check.within});
  const std::vector<std::string> found = misfits(result, fit, job.garment->bounds);
  if (is_published)
    note_misfit(row);
  else if (!found.empty())
    fail(combination, "failed: dressed, " + join(found, "; "));
  return true;
}

}  // namespace mssim
