#include <algorithm>
#include <cmath>

#include "backends/backends.h"
#include "bench/verification/verification.h"
#include "guide/guide.h"
#include "text/text.h"

namespace mssim {
namespace {

/// Wall time of a frame over the duration of a frame.
double share_of_frame(const SizeCurve& curve, const SizeCurve::Sample& sample, double frames_per_second) {
  return steps_a_frame(curve.dt_s, frames_per_second) * sample.seconds_a_step * frames_per_second;
}

/// Whether any sample from this number on keeps the lowest frame rate. One that does not may have been slowed
/// by another program.
bool holds_any(const SizeCurve& curve, std::size_t first) {
  return std::any_of(curve.samples.begin() + static_cast<std::ptrdiff_t>(first), curve.samples.end(),
                     [&](const SizeCurve::Sample& sample) {
                       return share_of_frame(curve, sample, frame_rates.front()) <= 1;
                     });
}

/// The x at which the line through both points, on logarithmic axes, has y = 1.
double where_one(double x_a, double y_a, double x_b, double y_b) {
  const double t = std::log(y_a) / (std::log(y_a) - std::log(y_b));
  return x_a * std::pow(x_b / x_a, t);
}

/// Throws BackendFailure if a state after `steps` of a cloth is far from that of mssim's own backend: a
/// program that is right on the scene may step other cloths wrongly, or not at all. Allows a tenth of the
/// longest way of a node, or a hundredth of a rest length, because roundings of many short steps may be that
/// large.
void require_near_own(const SizeCurve& curve, const FamilyCloth& cloth, const ExecutionOptions& execution,
                      int steps, const State& found) {
  constexpr double of_way = 0.1, of_rest_length = 0.01;
  const BackendInfo& own = best_host_backend();
  if (curve.backend->name == own.name) return;
  std::unique_ptr<Backend> backend;
  try {
    backend = make_backend(own, cloth.system, *curve.integrator, curve.dt_s, execution);
  } catch (const Unavailable&) {  // it has no threads, say: nothing is known against the other one
    return;
  }
  backend->set_state(cloth.system.start);
  backend->step(steps);
  const State expected = backend->state();
  if (first_bad_node(expected)) return;  // the step is too long for this cloth
  const double off = position_deviation(cloth.system, expected, found);
  const double way = position_deviation(cloth.system, cloth.system.start, expected);
  if (first_bad_node(found) || off > std::max(of_way * way, of_rest_length))
    throw BackendFailure(
        fmt::format("a node of a cloth of {} nodes is {:.3g} rest lengths away from where {} "
                    "has it after {}",
                    cloth.system.nodes(), off, own.name, pluralize(steps, "step")),
        "");
}

/// A sample of this cloth; none if the backend does not run, and curve.status gives the reason.
std::optional<SizeCurve::Sample> sample_of(SizeCurve& curve, const FamilyCloth& cloth,
                                           ExecutionOptions execution) {
  constexpr double enough_s = 0.02;
  constexpr int most_steps = 200;
  execution.scene_file = cloth.file;
  // As many steps as in a frame, so that solvers have the same work as there.
  const int steps = std::min(most_steps, steps_a_frame(curve.dt_s, frame_rates.front()));
  SizeCurve::Sample sample{cloth.system.nodes(), 0};
  const Ending ending = ending_of([&] {
    auto backend = make_timed_backend(*curve.backend, cloth.system, *curve.integrator, curve.dt_s, execution);
    sample.seconds_a_step = time_steps(*backend, cloth.system, steps, enough_s).seconds;
    const State found = backend->state();
    backend.reset();
    require_near_own(curve, cloth, execution, steps, found);
  });
  if (ending.lack == Lack::nothing) return sample;
  curve.status = ending.status();
  return std::nullopt;
}

}  // namespace

int steps_a_frame(double dt_s, double frames_per_second) {
  // A step that is too long only by rounding fits.
  return std::max(1, static_cast<int>(std::ceil(1 / (frames_per_second * dt_s) - 1e-9)));
}

std::optional<SizeCurve::Largest> SizeCurve::largest(double frames_per_second) const {
  if (samples.empty()) return std::nullopt;
  const auto share = [&](std::size_t i) { return share_of_frame(*this, samples[i], frames_per_second); };
  std::size_t holding = samples.size();
  while (holding > 0 && share(holding - 1) > 1) --holding;
  if (holding == 0) return Largest{0, false};
  const auto nodes = [&](std::size_t i) { return static_cast<double>(samples[i].nodes); };
  if (holding == samples.size()) return Largest{nodes(holding - 1), true};
  return Largest{where_one(nodes(holding - 1), share(holding - 1), nodes(holding), share(holding)), false};
}

std::optional<double> crossover(const SizeCurve& a, const SizeCurve& b) {
  const auto ratio = [&](std::size_t i) { return a.samples[i].seconds_a_step / b.samples[i].seconds_a_step; };
  const auto nodes = [&](std::size_t i) { return static_cast<double>(a.samples[i].nodes); };
  const std::size_t common = std::min(a.samples.size(), b.samples.size());
  if (common == 0 || (ratio(0) > 1) == (ratio(common - 1) > 1)) return std::nullopt;
  std::size_t first = common - 1;  // of the largest sizes, at which the same backend is the faster one
  while ((ratio(first - 1) > 1) == (ratio(first) > 1)) --first;
  return where_one(nodes(first - 1), ratio(first - 1), nodes(first), ratio(first));
}

void measure_sizes(std::span<SizeCurve> curves, const ClothMaker& make, const ExecutionOptions& execution,
                   const std::function<bool(const std::string& activity)>& go_on) {
  std::vector<SizeCurve*> active;
  for (SizeCurve& curve : curves)
    if (curve.status.empty()) active.push_back(&curve);
  for (std::size_t size = 0; size < cloth_sides.size() && !active.empty(); ++size) {
    const std::uint64_t nodes = std::uint64_t{cloth_sides[size]} * cloth_sides[size];
    std::optional<FamilyCloth> cloth;
    std::vector<SizeCurve*> still_active;
    for (SizeCurve* curve : active) {
      const std::string activity = pluralize(nodes, "node") + ": " + std::string(curve->integrator->name) +
                                   ' ' + std::string(curve->backend->name);
      if (!go_on(activity)) {
        curve->status = "no time was left for larger cloths";
        continue;
      }
      if (!cloth) cloth = make(cloth_sides[size]);
      const auto sample = sample_of(*curve, *cloth, execution);
      if (!sample) continue;
      curve->samples.push_back(*sample);
      if (size == 0 || holds_any(*curve, size - 1)) still_active.push_back(curve);
    }
    active = std::move(still_active);
  }
}

}  // namespace mssim
