#pragma once

#include <cmath>
#include <cstdint>

namespace mssim {

/// Moments at equal times of a simulation, from its start on: a frame is the step nearest to its time.
struct FrameGrid {
  double steps_per_frame = 1;  ///< at least 1, so that no two frames are the same step

  /// Steps done when frame `frame` is taken.
  std::int64_t step_of(std::int64_t frame) const {
    return std::llround(static_cast<double>(frame) * steps_per_frame);
  }
};

}  // namespace mssim
