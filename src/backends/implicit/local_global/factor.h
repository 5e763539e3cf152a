#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "backends/layouts/grouped.h"
#include "backends/layouts/node_arrays.h"
#include "model/system.h"

namespace mssim {

/// The constant matrix of fast-springs' global step: M + h^2 L of Liu et al. 2013, Eq. 14, with damping. It
/// is the matrix of backward Euler for the velocities w at the step's end,
///
///     A = (1 + dt viscous_damping) M + sum over springs of (dt^2 k + dt c) g g^T,   kg,
///
/// g: +1 at one end of the spring, -1 at the other. It is the same for all three coordinates. Pinned nodes
/// have no row, so a spring to one adds only to the diagonal. A is positive definite, because masses are
/// positive and spring constants are not negative.
struct StepMatrix {
  /// A spring between two free nodes: -weight at (first, second) and (second, first). Both diagonals already
  /// include it.
  struct Coupling {
    std::uint32_t first, second;  ///< rows
    double weight;                ///< kg
  };

  std::vector<std::uint32_t> node;  ///< [rows] the scene's node, ascending, only free ones
  std::vector<double> diagonal;     ///< [rows] kg
  std::vector<Coupling> couplings;

  StepMatrix(const System& system, double dt_s);
  std::size_t rows() const { return node.size(); }
};

/// A = P^T L L^T P (Cholesky), L by columns. P maps row order[i] of the matrix to place i.
struct ColumnFactor {
  std::vector<std::uint32_t> order;  ///< [rows]
  std::vector<std::size_t> first;    ///< [rows + 1] begin of each column of L
  std::vector<std::uint32_t> place;  ///< [entries] ascending in a column, the diagonal first
  std::vector<double> value;         ///< [entries]
};

/// Factorises the matrix in an approximate minimum degree order (Amestoy, Davis and Duff 1996). Throws
/// Unsupported if there is too little memory, or if the matrix is not positive definite.
ColumnFactor factorise(const StepMatrix& matrix);

/// Throws Unsupported if there is too little memory for a factor's `entries`, with entry_bytes each.
void require_factor_memory(std::size_t entries, std::size_t entry_bytes);

/// An order of elimination with little fill-in and independent work for threads: nested dissection (A.
/// George, 1973) by the nodes' positions, for each connected component. The rows of a region are cut at half
/// of their number along its longest side; those of one half with couplings into the other are the separator,
/// which is eliminated after both remainders, which are cut in the same way.
struct Dissection {
  static constexpr std::uint32_t no_part = std::numeric_limits<std::uint32_t>::max();

  /// A separator, or a region that is small enough: places [begin, end) of `order`.
  struct Part {
    std::uint32_t begin, end;
    std::uint32_t parent;  ///< a later part that separates this one from its sibling; or no_part
  };
  std::vector<std::uint32_t> order;  ///< [rows] the row at each place
  std::vector<Part> parts;           ///< in the order of elimination; none is empty

  /// `places`: [rows] m. Regions of at most `smallest` rows are not cut.
  Dissection(const StepMatrix& matrix, std::span<const Vec3d> places, std::size_t smallest);
};

/// The structure of each part's elimination (the fronts of I. S. Duff and J. K. Reid, 1983). The front of a
/// part is a list of places: first its border, ascending, which are later places coupled with its rows or
/// those of earlier parts, then the part's own places.
struct Fronts : Dissection {
  std::vector<std::size_t> first_border;  ///< [parts + 1] begin of a part's border
  std::vector<std::uint32_t> border;      ///< places
  std::vector<std::uint32_t> at_parent;   ///< [border] index of that place in the parent's front
  Grouped<std::uint32_t> children;        ///< by part: parts, ascending

  Fronts(const StepMatrix& matrix, Dissection dissection);

  std::size_t pivots(std::size_t part) const { return parts[part].end - parts[part].begin; }
  std::size_t border_size(std::size_t part) const { return first_border[part + 1] - first_border[part]; }
  std::size_t rows(std::size_t part) const { return border_size(part) + pivots(part); }
  /// Index of a place in the front of a part that has it.
  std::size_t at(std::size_t part, std::uint32_t place) const;
};

/// The inverse of a StepMatrix as dense blocks: its parts are eliminated one after the other (multifrontal
/// method: Duff and Reid 1983), each as a block that stores the inverse of its pivots, so solving consists
/// only of products of dense blocks with vectors. For a part with the matrix F of its front, r: border, p:
/// pivots,
///
///     panel = (-F_rp F_pp^-1; F_pp^-1),   [pivots] columns of `rows` floats, which are whole vectors.
///
/// Upwards, children before parents, with e the right-hand side at the part's places plus its children's
/// contributions:  contribution to the parent += -F_rp F_pp^-1 e,  z = F_pp^-1 e.  Downwards, with s_r the
/// solution at the border:  s_p = z + (-F_rp F_pp^-1)^T s_r.
struct BlockFactor {
  /// Data of a part for solving.
  struct Block {
    std::size_t panel;  ///< offset in `panels`
    std::size_t rows;   ///< floats per column, and per coordinate of the front
    std::size_t front;  ///< offset of its front in the array of fronts, [3][rows]
  };

  Fronts fronts;
  std::vector<Block> blocks;  ///< [parts]
  AlignedArray panels;
  std::size_t front_floats = 0;  ///< size of the array of fronts
  std::size_t most_rows = 0;     ///< maximum over the blocks

  /// `places`: [rows of the matrix] m; `lanes`: floats of a vector. Throws Unsupported like factorise().
  BlockFactor(const StepMatrix& matrix, std::span<const Vec3d> places, std::size_t lanes);

  /// Cost of a part, in floats: its panel, and about as much for each row of its front.
  std::size_t cost(std::size_t part) const;

 private:
  void eliminate_all(const StepMatrix& matrix);
};

}  // namespace mssim
