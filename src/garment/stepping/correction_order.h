#pragma once

#include <cstdint>
#include <vector>

#include "garment/garment.h"
#include "model/system.h"

namespace mssim {

/// A panel is cut into blocks of at least so many rows, which are corrected side by side. Small enough that a
/// panel makes work for several threads, large enough that corrections travel.
inline constexpr std::uint32_t correction_block_rows = 16;

/// The rows at which a panel's blocks begin, and its number of rows at the end.
std::vector<std::uint32_t> correction_blocks(const GarmentPanel& panel);

/// The springs whose elongation is limited, structural and shear, as numbers into System::springs, in the
/// order in which velocities are corrected: within each block along the rows, along the columns and along
/// the two kinds of diagonals, then in the same order of directions what joins a block to the next. Springs
/// of one line follow each other, so that a correction travels along it; lines of one direction have no node
/// in common, nor have blocks, so that they may be corrected side by side with the same result. Forwards and
/// backwards by turns this converges several times as fast as an order that colours single springs.
/// Throws std::invalid_argument where the springs are not those of the panels.
std::vector<std::uint32_t> correction_order(const Garment& garment, const std::vector<Spring>& springs);

}  // namespace mssim
