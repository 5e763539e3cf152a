#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "backends/implicit/local_global/dissection.h"

namespace mssim {

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

}  // namespace mssim
