#include "garment/pattern/close_cloth.h"

#include <algorithm>
#include <set>

namespace mssim {

CloseCloth close_cloth(const CloseSeams& close, const Garment& garment) {
  std::set<std::uint32_t> nodes;
  const auto add_beside = [&](std::uint32_t sewn) {
    const GarmentPanel& panel = garment.panel_of(sewn);
    const std::uint32_t row = (sewn - panel.first_node) / panel.columns;
    for (std::uint32_t column = 0; column < panel.columns; ++column) {
      const std::uint32_t node = panel.node(row, column);
      if (length(garment.flat[node] - garment.flat[sewn]) <= close.reach) nodes.insert(node);
    }
  };
  for (const Joint& joint : garment.joints) {
    if (std::ranges::find(close.seams, garment.seams[joint.seam]) == close.seams.end()) continue;
    for (const std::uint32_t sewn : {joint.node, joint.edge_first, joint.edge_second}) add_beside(sewn);
  }
  return {{nodes.begin(), nodes.end()}, close.lowest, close.highest};
}

}  // namespace mssim
