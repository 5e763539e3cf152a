#pragma once

#include <hdf5.h>

#include "geometry/surface.h"
#include "model/system.h"

namespace mssim {

/// The body in a trace that garments are dressed on. It does not move and is there once, whatever the frames:
///
///     /body/points                            [points][3] float32, m
///     /body/triangles                         [triangles][3] uint32, counter-clockwise seen from outside

/// Throws std::invalid_argument where a body, which may be empty, has triangles beyond its points, points
/// without triangles, or stands beside something that is no garment.
void require_fitting_body(const Topology& topology, const Surface& body);

/// Writes the body, an empty one not at all. Throws Hdf5Error.
void write_static_body(hid_t file, const Surface& body);

}  // namespace mssim
