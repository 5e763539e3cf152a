#pragma once

#include "garment/pattern/panel_mesh.h"

namespace mssim {

/// Throws InputError, which names panel, place and remedy, unless the corners of the piece meet to a tenth of
/// a millimetre and its boundaries neither cross nor touch each other or themselves elsewhere.
void require_simple_boundary(const PatternPiece& piece);

}  // namespace mssim
