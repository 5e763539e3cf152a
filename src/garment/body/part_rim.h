#pragma once

#include <vector>

#include "geometry/surface.h"

namespace mssim {

/// Leaves out what lies within 3 cm of the triangles that do not stay: where a hand has been cut off a hip,
/// the lip between them, whose edge would stand out of the patch over the cut, and thorns where they nearly
/// touch. Nearness is that of a triangle's corners to corners and middles of those left out.
void leave_out_rim(const Surface& surface, std::vector<bool>& stays);

}  // namespace mssim
