#pragma once

#include <hdf5.h>

#include <cstddef>

#include "garment/garment.h"

namespace mssim {

/// Reads what h5md_garment.h writes: panels, seams and joints. How the garment was dressed, and the length
/// and strength of joints, are not in a trace. Throws Hdf5Error, Hdf5ContentError, and std::invalid_argument
/// where the garment does not fit the nodes.
Garment read_garment(hid_t file, std::size_t nodes);

}  // namespace mssim
