#include "garment/layers/panel_layers.h"

#include <algorithm>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include "text/text.h"

namespace mssim {
namespace {

std::uint32_t panel_of(const Garment& garment, std::uint32_t node) {
  const auto holds = [&](const GarmentPanel& panel) {
    return node >= panel.first_node && node - panel.first_node < panel.nodes();
  };
  return static_cast<std::uint32_t>(std::ranges::find_if(garment.panels, holds) - garment.panels.begin());
}

std::string quoted(const GarmentPanel& panel) { return '"' + printable(panel.name) + '"'; }

void validate_panel(std::uint32_t index, const Garment& garment, std::size_t nodes) {
  if (index >= garment.panels.size())
    throw std::invalid_argument("cloth layers: there is no panel " + std::to_string(index) +
                                ", the garment has " + std::to_string(garment.panels.size()) +
                                ", counted from 0");
  const GarmentPanel& panel = garment.panels[index];
  if (panel.rows < 2 || panel.columns < 2)
    throw std::invalid_argument("cloth layers: panel " + quoted(panel) + " has " +
                                std::to_string(panel.rows) + " x " + std::to_string(panel.columns) +
                                " nodes, give it at least 2 x 2");
  const std::uint64_t end = panel.first_node + std::uint64_t{panel.rows} * panel.columns;
  if (end > nodes)
    throw std::invalid_argument("cloth layers: panel " + quoted(panel) + " ends at node " +
                                std::to_string(end) + ", but there are only " + std::to_string(nodes) +
                                " nodes, each of which needs a mass");
}

}  // namespace

std::vector<PanelPair> layer_pairs(const Garment& garment) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> sewn;
  for (const Joint& joint : garment.joints) {
    const std::uint32_t from = panel_of(garment, joint.node), onto = panel_of(garment, joint.edge_first);
    sewn.insert(std::minmax({from, onto}));
  }
  std::vector<PanelPair> pairs;
  const auto panels = static_cast<std::uint32_t>(garment.panels.size());
  for (std::uint32_t inner = 0; inner < panels; ++inner) {
    for (std::uint32_t outer = 0; outer < panels; ++outer) {
      if (garment.panels[inner].layer < garment.panels[outer].layer &&
          !sewn.contains(std::minmax({inner, outer})))
        pairs.push_back({inner, outer});
    }
  }
  return pairs;
}

void validate_layers(const ClothLayers& layers, const Garment& garment, std::size_t nodes) {
  for (const std::uint32_t panel : layers.mirrored) validate_panel(panel, garment, nodes);
  std::set<std::pair<std::uint32_t, std::uint32_t>> known;
  for (const auto& [inner, outer] : layers.pairs) {
    validate_panel(inner, garment, nodes);
    validate_panel(outer, garment, nodes);
    if (inner == outer)
      throw std::invalid_argument("cloth layers: panel " + quoted(garment.panels[inner]) +
                                  " is paired with itself, but only collisions of different panels are "
                                  "found: name another one");
    if (!known.insert(std::minmax({inner, outer})).second)
      throw std::invalid_argument("cloth layers: panels " + quoted(garment.panels[inner]) + " and " +
                                  quoted(garment.panels[outer]) + " are paired twice: name each pair once");
  }
}

}  // namespace mssim
