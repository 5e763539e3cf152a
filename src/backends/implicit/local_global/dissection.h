#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "backends/implicit/local_global/step_matrix.h"

namespace mssim {

/// An order of elimination that fills a factor little and gives threads work that does not depend on each
/// other: nested dissection (A. George, 1973) by the nodes' places, of each piece that hangs together. The
/// rows of a region are cut where its
/// longest side has half of them; those of one half that have a coupling into the other are the separator,
/// which is eliminated after both rests, which are cut in the same way.
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

}  // namespace mssim
