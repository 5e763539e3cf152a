#pragma once

#include <vector>

#include "geometry/vec3.h"
#include "output/traces/trace_content.h"

namespace mssim {

/// [nodes] The mean strain of the springs at each node, at these positions ([nodes] m); 0 where there are
/// none. `content` has rest lengths.
std::vector<double> node_strain(const TraceContent& content, const std::vector<Vec3d>& positions);

}  // namespace mssim
