#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "model/system.h"

namespace mssim {

/// A cloth of which no process here has the whole, and the windows by which it is verified.
struct WindowedCloth {
  GridPatch grid;
  std::uint64_t springs = 0;        ///< unique ones of the whole
  std::vector<GridWindow> windows;  ///< of one size; no two overlap
  /// Builds the nodes of a window with the springs between them, at the scene's start state.
  std::function<System(const GridWindow& window)> build;

  std::uint64_t nodes() const { return std::uint64_t{grid.rows} * grid.columns; }
  std::uint64_t nodes_in_windows() const {
    return windows.empty() ? 0 : windows.size() * windows.front().nodes();
  }
};

/// The number that a node of a window has in the whole cloth.
inline std::size_t node_of_cloth(const GridWindow& window, std::size_t node, const GridPatch& grid) {
  return (window.row + node / window.columns) * grid.columns + window.column + node % window.columns;
}

}  // namespace mssim
