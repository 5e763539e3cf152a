#pragma once

#include "geometry/surface.h"

namespace mssim {

/// Requires of a surface that a reader returned: finite points, each at a place of its own and in a triangle,
/// indices in range; written as OBJ it reads back the same; corners that are joined
/// are those of several triangles; its openings can be closed or are refused, and
/// how it stands is guessed or refused; and where it passes for closed, it has edges and a finite volume.
void check_surface(const Surface& surface);

}  // namespace mssim
