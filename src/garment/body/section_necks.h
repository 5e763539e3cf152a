#pragma once

#include <vector>

#include "garment/body/section_loops.h"

namespace mssim {

/// Cuts off what is joined to a loop by a narrow neck, as a hand is that rests against a hip: by a chord of
/// at most 0.6 of the outline that it cuts off, with at most a quarter of the area, all on one side of x = 0.
/// The narrowest necks go first. What remains of the loop stands at the front. Halves of a trunk above the
/// crotch are no such parts, being of a size, nor are bulges, which have no neck.
std::vector<SectionLoop> cut_at_necks(SectionLoop loop);

}  // namespace mssim
