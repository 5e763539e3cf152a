#include "garment/fitting/dress.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "statistics/statistics.h"

namespace mssim {
namespace {

/// Distance that a share of the nodes has moved less than, m.
double moved(const State& before, const State& after, double fraction) {
  std::vector<double> distances;
  distances.reserve(after.position.size());
  for (std::size_t i = 0; i < after.position.size(); ++i)
    distances.push_back(length(after.position[i] - before.position[i]));
  return quantile(std::move(distances), fraction);
}

/// Delivers the frames of a dressing in their order.
class FrameDelivery {
 public:
  explicit FrameDelivery(const DressingFrames& frames) : frames_(frames) {}

  /// Steps after which the next frame is due; none where nobody looks.
  std::optional<std::int64_t> due() const {
    return frames_.on_frame ? std::optional(frames_.grid.step_of(next_)) : std::nullopt;
  }
  void deliver(const State& state, std::int64_t iterations) {
    if (!frames_.on_frame) return;
    frames_.on_frame(state, iterations);
    ++next_;
  }

 private:
  const DressingFrames& frames_;
  std::int64_t next_ = 0;
};

/// Steps from `done` to `end`, where it leaves a frame that is due to the caller.
void step_through(DressingBackend& backend, std::int64_t done, std::int64_t end, FrameDelivery& frames) {
  for (auto due = frames.due(); due && *due < end; due = frames.due()) {
    backend.step(static_cast<int>(*due - done));
    done = *due;
    frames.deliver(backend.state(), done);
  }
  backend.step(static_cast<int>(end - done));
}

}  // namespace

DressingResult dress(DressingBackend& backend, const System& system, double dt_s, const SettlingRule& rule,
                     const OnWindow& on_window, const DressingFrames& frames) {
  const int window = std::max(1, static_cast<int>(std::lround(rule.window_s / dt_s)));
  const auto longest = static_cast<std::int64_t>(std::llround(rule.longest_s / dt_s));
  backend.set_state(system.start);
  DressingResult result;
  result.state = system.start;
  FrameDelivery delivery(frames);
  delivery.deliver(result.state, 0);
  bool goes_on = longest > 0;
  while (goes_on) {
    const bool was_draping = backend.progress().draping;
    const std::int64_t end = std::min(result.iterations + window, longest);
    const bool whole_window = end - result.iterations == window;
    step_through(backend, result.iterations, end, delivery);
    result.iterations = end;
    State state = backend.state();
    if (backend.progress().draping) result.seamed_at = backend.progress().seamed_at;
    // A window that began with open seams, or that was cut short, says nothing about how a sewn garment
    // rests.
    result.settled = was_draping && whole_window && moved(result.state, state, rule.fraction) < rule.distance;
    result.state = std::move(state);
    goes_on = on_window(result.state, result.iterations) && !result.settled && result.iterations < longest;
    if (!goes_on || delivery.due() == result.iterations) delivery.deliver(result.state, result.iterations);
  }
  result.simulated_s = static_cast<double>(result.iterations) * dt_s;
  return result;
}

}  // namespace mssim
