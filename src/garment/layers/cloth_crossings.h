#pragma once

#include <cstddef>
#include <span>

#include "garment/garment.h"
#include "garment/layers/cloth_contacts.h"
#include "geometry/vec3.h"

namespace mssim {

/// How often two panels cross: pairs of an edge of one panel (sides and diagonals of cells, diagonals from
/// low left to high right) and a triangle of the other such that the edge runs through the triangle. 0 where
/// the panels are apart, however near, and also where one is wholly on its wrong side.
///
/// Signs of volumes decide, in double precision and without a tolerance; those at the side that two triangles
/// share are computed once for both, so that an edge which runs through it crosses exactly one of them. Meant
/// for checks, not for every step. position: [nodes] m, finite.
std::size_t count_crossings(const GarmentPanel& first, const GarmentPanel& second,
                            std::span<const Vec3d> position);

/// The sum over all pairs of layers.
std::size_t count_crossings(const Garment& garment, const ClothLayers& layers,
                            std::span<const Vec3d> position);

}  // namespace mssim
