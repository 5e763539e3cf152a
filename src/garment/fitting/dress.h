#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "garment/stepping/dressing_backend.h"
#include "model/system.h"

namespace mssim {

/// When a garment counts as settled, and how long that may take.
struct SettlingRule {
  double window_s = 0.05;    ///< of simulated time
  double distance = 0.0005;  ///< m that nodes may move within it
  double fraction = 0.99;    ///< of the nodes that must move less
  double longest_s = 4;      ///< of simulated time, seaming included
};

/// How a dressing went.
struct DressingResult {
  State state;                            ///< at the end
  std::int64_t iterations = 0;            ///< steps in all
  std::optional<std::int64_t> seamed_at;  ///< steps after which all seams were closed
  bool settled = false;                   ///< or else the longest time was over
  double simulated_s = 0;
};

/// Called after every window with the state and the number of steps; returns whether to go on.
using OnWindow = std::function<bool(const State& state, std::int64_t iterations)>;

/// Moments of a dressing to look at: the start, those of the grid, and the end. They change nothing.
struct DressingFrames {
  FrameGrid grid;
  /// Called with the state and the number of steps; none where nobody looks.
  std::function<void(const State& state, std::int64_t iterations)> on_frame;
};

/// Dresses: from the system's start until the seams are closed and the garment has settled, or the longest
/// time is over. A frame at the end of a window comes after on_window.
DressingResult dress(DressingBackend& backend, const System& system, double dt_s, const SettlingRule& rule,
                     const OnWindow& on_window, const DressingFrames& frames = {});

}  // namespace mssim
