#pragma once

#include <cstddef>

#include "model/system.h"

namespace mssim {

/// A cloth laid out for vectors of `lanes` floats: the rows are cut into `lanes` bands of `height` rows, and
/// lane b holds band b. A row of the layout is thus `lanes` nodes that lie `height` rows apart, and every
/// neighbour of a node is an aligned load of the same lane, without a shuffle or a gather.
///
/// Measured on two Zen 4 cores at 500 x 700 against the plain spring list: gathering 12 neighbours from a
/// structure of arrays 17 times as fast, this layout, which computes each spring once, 29 times.
///
///     [column][row -2 .. height + 1][x y z u v w][lane]       (u v w: velocity)
///
/// The cloth may be folded: its columns are cut into halves that lie side by side in the lanes, so that there
/// are lanes / 2 bands, twice as high. Column c of the layout is then two columns of the cloth; which ones,
/// who walks over them says (BandPartition). A small cloth leaves fewer rows empty so, and columns are half
/// as many, each of which takes some time beside its rows.
///
/// Two halo rows above and below are room for the neighbouring bands' rows: opencl keeps them there, openmp
/// puts them there only where it reads them. Rows that the last bands have too many are dummies: they stay at
/// rest and no force from them reaches a node of the cloth (BandRows).
struct BandLayout {
  std::size_t lanes;
  std::size_t halves;         ///< of the columns, side by side in the lanes: 1 or 2
  std::size_t bands;          ///< lanes of a half
  std::size_t rows, columns;  ///< of the cloth
  std::size_t height;         ///< rows in a band

  BandLayout(const GridPatch& grid, std::size_t lane_count, std::size_t half_count = 1);

  static constexpr std::size_t halo = 2;        ///< longest spring, in rows or columns
  static constexpr std::size_t components = 6;  ///< position and velocity
  std::size_t row_floats() const { return components * lanes; }
  std::size_t column_floats() const { return (height + 2 * halo) * row_floats(); }
  /// Floats from a column's start to the x of the node in a row of the cloth.
  std::size_t offset(std::size_t row, std::size_t half = 0) const {
    return (row % height + halo) * row_floats() + half * bands + row / height;
  }
  /// Floats of one column of forces: rows 0 .. height, three components. The last row holds what
  /// the first row gives to the column's last row, a lane before.
  std::size_t force_floats() const { return (height + 1) * 3 * lanes; }
};

}  // namespace mssim
