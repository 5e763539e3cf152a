#pragma once

#include <span>

#include "guide/work_point.h"

namespace mssim {

/// Marks the points that no other one beats: one that counts and is no slower, no less accurate and, in one
/// of the two, better. Points that do not count are never on the front.
void mark_pareto_front(std::span<WorkPoint> points);

}  // namespace mssim
