#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "backends/layouts/node_arrays.h"
#include "model/system.h"

namespace mssim {

/// The constant matrix of fast-springs' global step: M + h^2 L of Liu et al. 2013, Eq. 14, with damping. It
/// is that of the equation of backward Euler in the velocities w at the step's end,
///
///     A = (1 + dt viscous_damping) M + sum over springs of (dt^2 k + dt c) g g^T,   kg,
///
/// g: +1 at one end of the spring, -1 at the other. All three coordinates have the same one. Pinned nodes
/// have no row, so that a spring to one adds to the diagonal alone. A is positive definite, because masses
/// are positive and springs are not negative.
struct StepMatrix {
  /// A spring between two free nodes: -weight at (first, second) and (second, first). Both diagonals have it
  /// already.
  struct Coupling {
    std::uint32_t first, second;  ///< rows
    double weight;                ///< kg
  };

  std::vector<std::uint32_t> node;  ///< [rows] the scene's node, ascending: the free ones
  std::vector<double> diagonal;     ///< [rows] kg
  std::vector<Coupling> couplings;

  StepMatrix(const System& system, double dt_s);
  std::size_t rows() const { return node.size(); }
};

/// A = P^T L L^T P (Cholesky), L by columns. P takes row order[i] of the matrix to place i.
struct ColumnFactor {
  std::vector<std::uint32_t> order;  ///< [rows]
  std::vector<std::size_t> first;    ///< [rows + 1] where a column of L begins
  std::vector<std::uint32_t> place;  ///< [entries] ascending in a column, whose diagonal comes first
  std::vector<double> value;         ///< [entries]
};

/// Factorises the matrix in an approximate minimum degree order (Amestoy, Davis and Duff 1996). Throws
/// Unsupported where there is not the memory for it, or where the matrix is not positive definite.
ColumnFactor factorise(const StepMatrix& matrix);

/// Throws Unsupported where a factor's `entries`, which take so many bytes each, are more than there is
/// memory for.
void require_factor_memory(std::size_t entries, std::size_t entry_bytes);

/// An order of elimination that fills a factor little and gives threads work that does not depend on each
/// other: nested dissection (A. George, 1973) by the nodes' places, of each piece that hangs together. The
/// rows of a region are cut where its longest side has half of them; those of one half that have a coupling
/// into the other are the separator, which is eliminated after both rests, which are cut in the same way.
struct Dissection {
  static constexpr std::uint32_t no_part = std::numeric_limits<std::uint32_t>::max();

  /// A separator, or a region that is small enough: places [begin, end) of `order`.
  struct Part {
    std::uint32_t begin, end;
    std::uint32_t parent;  ///< a later part, which separates this one from its sibling; or no_part
  };
  std::vector<std::uint32_t> order;  ///< [rows] the row at each place
  std::vector<Part> parts;           ///< in the order of elimination; none is empty

  /// `places`: [rows] m. Regions of at most `smallest` rows are cut no further.
  Dissection(const StepMatrix& matrix, std::span<const Vec3d> places, std::size_t smallest);
};

/// What each part of a dissection touches when it is eliminated (the fronts of I. S. Duff and J. K. Reid,
/// 1983). The front of a part is a list of places: first its border, ascending, which are later places that
/// its rows or those of the parts before it have couplings with, then the part's own places.
struct Fronts {
  std::vector<Dissection::Part> parts;
  std::vector<std::size_t> first_border;   ///< [parts + 1] where a part's border begins
  std::vector<std::uint32_t> border;       ///< places
  std::vector<std::uint32_t> at_parent;    ///< [border] where that place is in the front of the parent
  std::vector<std::uint32_t> first_child;  ///< [parts + 1] where a part's children begin
  std::vector<std::uint32_t> children;     ///< parts, ascending

  Fronts(const StepMatrix& matrix, const Dissection& dissection);

  std::size_t pivots(std::size_t part) const { return parts[part].end - parts[part].begin; }
  std::size_t border_size(std::size_t part) const { return first_border[part + 1] - first_border[part]; }
  std::size_t rows(std::size_t part) const { return border_size(part) + pivots(part); }
  /// Where a place is in the front of a part that has it.
  std::size_t at(std::size_t part, std::uint32_t place) const;
  std::span<const std::uint32_t> children_of(std::size_t part) const {
    return std::span(children).subspan(first_child[part], first_child[part + 1] - first_child[part]);
  }
};

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
