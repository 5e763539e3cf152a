#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "backends/implicit/local_global/fronts.h"
#include "backends/layouts/aligned_array.h"

namespace mssim {

/// The inverse of a StepMatrix as dense blocks: its parts are eliminated one after the other (multifrontal
/// method: Duff and Reid 1983), each as a block whose pivots' inverse is stored, so that solving is nothing
/// but products of dense blocks with vectors. For a part with the matrix F of its front, r: border, p:
/// pivots,
///
///     panel = (-F_rp F_pp^-1; F_pp^-1),   [pivots] columns of `rows` floats, which are whole vectors.
///
/// Upwards, children before parents, with e the right-hand side of the part's places and what its children
/// have left there:  left for the parent += -F_rp F_pp^-1 e,  z = F_pp^-1 e.  Downwards, with s_r the
/// solution at the border:  s_p = z + (-F_rp F_pp^-1)^T s_r.
struct BlockFactor {
  /// What solving needs of a part.
  struct Block {
    std::size_t panel;  ///< where it begins in `panels`
    std::size_t rows;   ///< floats of a column, and of a coordinate of the front
    std::size_t front;  ///< where its front begins in the array of fronts, [3][rows]
  };

  std::vector<std::uint32_t> order;  ///< Dissection::order
  Fronts fronts;
  std::vector<Block> blocks;  ///< [parts]
  AlignedArray panels;
  std::size_t front_floats = 0;  ///< of the array of fronts
  std::size_t most_rows = 0;     ///< of a block

  /// `places`: [rows of the matrix] m; `lanes`: floats of a vector. Throws Unsupported like factorise().
  BlockFactor(const StepMatrix& matrix, std::span<const Vec3d> places, std::size_t lanes);

  /// What a part costs, in floats of its panel and about as much for each row of its front.
  std::size_t cost(std::size_t part) const;

 private:
  BlockFactor(const StepMatrix& matrix, const Dissection& dissection, std::size_t lanes);
  void eliminate_all(const StepMatrix& matrix);
};

}  // namespace mssim
