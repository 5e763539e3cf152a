#pragma once

#include <cstddef>
#include <span>

#include "garment/garment.h"
#include "garment/layers/panel_layers.h"
#include "geometry/vec3.h"

namespace mssim {

/// How often two panels cross: pairs of an edge of one panel (sides and diagonals of cells, diagonals from
/// low left to high right) and a triangle of the other such that the edge runs through the triangle. 0 where
/// the panels are apart, however near, and also where one is wholly on its wrong side: see
/// count_wrong_side().
///
/// Signs of volumes decide, in double precision and without a tolerance; those at the side that two triangles
/// share are computed once for both, so that an edge which runs through it crosses exactly one of them. Meant
/// for checks, not for every step. position: [nodes] m, finite.
std::size_t count_crossings(const GarmentPanel& first, const GarmentPanel& second,
                            std::span<const Vec3d> position);

/// The sum over all pairs of layers.
std::size_t count_crossings(const Garment& garment, const ClothLayers& layers,
                            std::span<const Vec3d> position);

/// The contacts within `reach` (m) that are on the wrong side of a panel (ClothContactSearch, in single
/// precision): how many nodes have gone through another layer, and not farther than that.
std::size_t count_wrong_side(const Garment& garment, const ClothLayers& layers,
                             std::span<const Vec3d> position, double reach);

}  // namespace mssim
