#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "guide/work_point.h"

namespace mssim {

/// What a user can bear.
struct Wish {
  double frames_per_second = 60;
  double error = 1e-3;  ///< of positions at the horizon, in mean rest lengths
};

/// Whole steps a frame that are no longer than dt_s.
int steps_a_frame(double dt_s, double frames_per_second);

/// What to take, as places in the points that it was chosen from.
struct Recommendation {
  std::optional<std::size_t> best;  ///< the cheapest that is accurate enough
  std::optional<std::size_t>
      runner_up;  ///< the cheapest such one of another integrator, else of another backend
  std::optional<std::size_t> nearest;  ///< the most accurate, where none is accurate enough
  bool holds_frames = false;           ///< the best computes a frame within its time
  std::vector<std::string> sentences;  ///< three, each with its full stop
};

/// The cheapest of the points that count and whose error is within the wish; how it stands to real time; and
/// when another one would be. `horizon_s`: when the errors were measured.
Recommendation recommend(std::span<const WorkPoint> points, const Wish& wish, double horizon_s);

}  // namespace mssim
