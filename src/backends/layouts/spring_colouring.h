#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "model/system.h"

namespace mssim {

/// A list of springs sorted into colours, no two springs of a colour sharing a node.
struct SpringColouring {
  std::vector<Spring> springs;     ///< [springs] colour by colour, in the order of the list within each
  std::vector<std::size_t> first;  ///< [colours + 1] where a colour begins

  std::size_t colours() const { return first.size() - 1; }
  std::span<const Spring> of_colour(std::size_t colour) const {
    return std::span(springs).subspan(first[colour], first[colour + 1] - first[colour]);
  }
};

/// Gives each spring in turn the first colour that neither of its ends has: at most twice as many colours,
/// less one, as the largest degree of a node. `nodes`: above all node numbers of the springs.
SpringColouring colour_springs(std::span<const Spring> list, std::size_t nodes);

}  // namespace mssim
