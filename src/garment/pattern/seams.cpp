#include "garment/pattern/seams.h"

#include <algorithm>
#include <cmath>

#include "geometry/geometry.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

/// The nodes of a stretch in the order of the seam.
struct StretchNodes {
  std::vector<std::uint32_t> nodes;
  std::vector<double> arcs;  ///< m, from the stretch's first node to each
  double drawn_length = 0;   ///< m, between its ends as they were drawn
};

std::string text_of(const SeamStretch& stretch) {
  return "the " + name_of(stretch.edge) + " boundary of " + stretch.panel + " from " + shown(stretch.from) +
         " to " + shown(stretch.to);
}

std::size_t panel_named(const std::string& where, const std::string& name,
                        std::span<const GarmentPanel> panels) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < panels.size(); ++i) {
    if (panels[i].name == name) return i;
    names.push_back(panels[i].name);
  }
  throw InputError(where + "there is no panel " + name + "; use one of " + join(names, ", "));
}

std::size_t nearest(const std::vector<double>& arcs, double arc) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < arcs.size(); ++i)
    if (std::abs(arcs[i] - arc) < std::abs(arcs[best] - arc)) best = i;
  return best;
}

StretchNodes nodes_of(const std::string& where, const SeamStretch& stretch,
                      std::span<const GarmentPanel> panels, std::span<const PanelMesh> meshes) {
  const std::size_t p = panel_named(where, stretch.panel, panels);
  const auto is_fraction = [](double x) { return x >= 0 && x <= 1; };
  if (!is_fraction(stretch.from) || !is_fraction(stretch.to) || stretch.from == stretch.to)
    throw InputError(where + text_of(stretch) +
                     " is not a valid stretch; give two different fractions from 0 to 1");
  const std::vector<double>& arcs = meshes[p].arcs_on(stretch.edge);
  const std::size_t begin = nearest(arcs, stretch.from * arcs.back());
  const std::size_t end = nearest(arcs, stretch.to * arcs.back());
  if (begin == end)
    throw InputError(where + text_of(stretch) +
                     " has fewer than two nodes; lengthen it or give the panel more nodes");
  const std::vector<std::size_t> on_edge = meshes[p].edge_nodes(stretch.edge);
  StretchNodes found;
  found.drawn_length = std::abs(stretch.to - stretch.from) * arcs.back();
  for (std::size_t i = begin;; begin < end ? ++i : --i) {
    found.nodes.push_back(panels[p].first_node + static_cast<std::uint32_t>(on_edge[i]));
    found.arcs.push_back(std::abs(arcs[i] - arcs[begin]));
    if (i == end) return found;
  }
}

/// Where a seam's fraction lies on its coarser side: nodes that a joint may have as its edge.
Joint place_at(const StretchNodes& coarser, double fraction) {
  constexpr double near_a_node = 0.05;  // of an edge: less than the seam's own unevenness
  const double arc = fraction * coarser.arcs.back();
  const auto after = std::upper_bound(coarser.arcs.begin() + 1, coarser.arcs.end() - 1, arc);
  const auto second = static_cast<std::size_t>(after - coarser.arcs.begin()), first = second - 1;
  const double on_edge = (arc - coarser.arcs[first]) / (coarser.arcs[second] - coarser.arcs[first]);
  Joint joint;
  joint.edge_first = coarser.nodes[on_edge < 1 - near_a_node ? first : second];
  joint.edge_second = coarser.nodes[on_edge > near_a_node ? second : first];
  joint.edge_share = joint.edge_first == joint.edge_second ? 0 : on_edge;
  return joint;
}

}  // namespace

std::vector<Joint> join_seam(const Seam& seam, std::span<const GarmentPanel> panels,
                             std::span<const PanelMesh> meshes, std::uint32_t seam_index) {
  const std::string where = "seam " + seam.name + ": ";
  const StretchNodes first = nodes_of(where, seam.first, panels, meshes);
  const StretchNodes second = nodes_of(where, seam.second, panels, meshes);
  const double longer = std::max(first.drawn_length, second.drawn_length);
  if (!(std::abs(first.drawn_length - second.drawn_length) <= seam.tolerance * longer))
    throw InputError(where + text_of(seam.first) + " is " + shown(first.drawn_length) + " m long and " +
                     text_of(seam.second) + " " + shown(second.drawn_length) +
                     " m; give them the same length or raise the seam's tolerance of " +
                     shown(seam.tolerance));
  const bool first_is_finer = first.nodes.size() >= second.nodes.size();
  const StretchNodes &finer = first_is_finer ? first : second, &coarser = first_is_finer ? second : first;
  std::vector<Joint> joints;
  joints.reserve(finer.nodes.size());
  const std::size_t last = finer.nodes.size() - 1;
  for (std::size_t i = 0; i <= last; ++i) {
    Joint joint = place_at(coarser, finer.arcs[i] / finer.arcs.back());
    joint.node = finer.nodes[i];
    joint.length = 0.5 * (finer.arcs[std::min(i + 1, last)] - finer.arcs[i == 0 ? 0 : i - 1]);
    joint.seam = seam_index;
    if (joint.node == joint.edge_first || joint.node == joint.edge_second)
      throw InputError(where + text_of(seam.first) + " and " + text_of(seam.second) + " share the node " +
                       std::to_string(joint.node) + "; use two separate stretches");
    joints.push_back(joint);
  }
  return joints;
}

}  // namespace mssim
