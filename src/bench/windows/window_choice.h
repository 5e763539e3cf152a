#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "model/topology.h"

namespace mssim {

/// Windows that a cloth is verified in unless a number is asked for.
inline std::size_t usual_windows(std::size_t parts) { return parts + 8; }

/// The fewest with which every part of the cloth has one: two corners, and the seams between the parts.
inline std::size_t fewest_windows(std::size_t parts) { return parts + 1; }

/// At most so many windows of one size, of which no two overlap: two opposite corners; the seams between the
/// columns of so many parts (part_of of layouts/column_range.h), so that every part has a window; the middle
/// of the pinned row; the other corners; and then places spread evenly over the cloth. The same ones for the
/// same arguments. On a small cloth there are fewer, because they leave each other no room.
std::vector<GridWindow> choose_windows(const GridPatch& grid, std::size_t parts,
                                       std::optional<std::uint32_t> pinned_row, std::size_t count);

}  // namespace mssim
