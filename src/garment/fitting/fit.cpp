#include "garment/fitting/fit.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include "garment/layers/cloth_contacts.h"
#include "garment/layers/cloth_crossings.h"
#include "laws/host_laws.h"
#include "statistics/statistics.h"

namespace mssim {
namespace {

double largest_gap(const Garment& garment, const std::vector<Vec3d>& position) {
  double largest = 0;
  for (const Joint& joint : garment.joints) {
    largest = std::max(largest, length(joint_gap(position[joint.node], position[joint.edge_first],
                                                 position[joint.edge_second], joint.edge_share)));
  }
  return largest;
}

void measure_side_distance(const CloseCloth& close, const std::vector<Vec3d>& position, const FitBody& body,
                           Fit& fit) {
  std::vector<Vec3d> points;
  for (const std::uint32_t node : close.nodes)
    if (position[node].y >= close.lowest && position[node].y <= close.highest)
      points.push_back(position[node]);
  if (points.empty()) return;
  const std::vector<double> distances = body.distances(points, close.lowest, close.highest);
  const auto farthest = std::ranges::max_element(distances);
  fit.side_distance = *farthest;
  fit.side_distance_height = points[static_cast<std::size_t>(farthest - distances.begin())].y;
}

/// Whether a spring of the 12-neighbour stencil is one whose elongation counts: one that spans a single cell.
/// Bending springs, two cells long, may change length by bending.
bool is_structural_or_shear(const Garment& garment, const Spring& spring) {
  const GarmentPanel& panel = garment.panel_of(spring.first);
  const std::uint32_t first = spring.first - panel.first_node, second = spring.second - panel.first_node;
  const auto apart = [](std::uint32_t a, std::uint32_t b) { return a < b ? b - a : a - b; };
  return apart(first / panel.columns, second / panel.columns) <= 1 &&
         apart(first % panel.columns, second % panel.columns) <= 1;
}

std::vector<double> elongations(const System& system, const Garment& garment,
                                const std::vector<Vec3d>& position) {
  std::vector<double> elongations;
  for (const Spring& spring : system.springs)
    if (is_structural_or_shear(garment, spring))
      elongations.push_back(length(position[spring.second] - position[spring.first]) / spring.rest_length -
                            1);
  return elongations;
}

/// Mean height of nodes, one or more, above where the pattern puts them.
double mean_rise(const Garment& garment, const std::vector<Vec3d>& position,
                 const std::vector<std::uint32_t>& nodes) {
  double rise = 0;
  for (const std::uint32_t node : nodes) rise += position[node].y - garment.flat[node].y;
  return rise / static_cast<double>(nodes.size());
}

/// Of the upper edges of each layer's panels, the mean rise that is farthest off.
double upper_edge_rise(const Garment& garment, const std::vector<Vec3d>& position) {
  std::map<std::uint32_t, std::vector<std::uint32_t>> edges;
  for (const GarmentPanel& panel : garment.panels)
    for (std::uint32_t column = 0; column < panel.columns; ++column)
      edges[panel.layer].push_back(panel.node(panel.rows - 1, column));
  double farthest = 0;
  for (const auto& [layer, nodes] : edges) {
    const double rise = mean_rise(garment, position, nodes);
    if (!(std::abs(rise) <= std::abs(farthest))) farthest = rise;
  }
  return farthest;
}

std::vector<std::uint32_t> where_seams_meet(const Garment& garment) {
  std::map<std::uint32_t, std::set<std::uint32_t>> seams_at;
  for (const Joint& joint : garment.joints) {
    seams_at[joint.node].insert(joint.seam);
    if (joint.edge_share == 0) seams_at[joint.edge_first].insert(joint.seam);
    if (joint.edge_share == 1) seams_at[joint.edge_second].insert(joint.seam);
  }
  std::vector<std::uint32_t> nodes;
  for (const auto& [node, seams] : seams_at)
    if (seams.size() > 1) nodes.push_back(node);
  return nodes;
}

/// Rows of two panels that are sewn to each other at both ends, as closed loops of nodes.
std::vector<std::vector<std::uint32_t>> sewn_rows(const Garment& garment) {
  // For each end of a row, the nodes of other panels that it is sewn to.
  std::multimap<std::uint32_t, std::uint32_t> sewn_to;
  for (const Joint& joint : garment.joints) {
    const std::uint32_t other = joint.edge_share < 0.5 ? joint.edge_first : joint.edge_second;
    sewn_to.emplace(joint.node, other);
    sewn_to.emplace(other, joint.node);
  }
  const auto rows_sewn_to = [&](std::uint32_t node) {
    std::map<const GarmentPanel*, std::uint32_t> rows;
    for (auto [to, end] = sewn_to.equal_range(node); to != end; ++to) {
      const GarmentPanel& panel = garment.panel_of(to->second);
      rows.emplace(&panel, (to->second - panel.first_node) / panel.columns);
    }
    return rows;
  };
  std::vector<std::vector<std::uint32_t>> loops;
  for (const GarmentPanel& panel : garment.panels)
    for (std::uint32_t row = 0; row < panel.rows; ++row) {
      const auto left = rows_sewn_to(panel.node(row, 0));
      const auto right = rows_sewn_to(panel.node(row, panel.columns - 1));
      for (const auto& [other, other_row] : left) {
        if (other < &panel || !right.contains(other)) continue;  // each pair once
        std::vector<std::uint32_t> loop;
        for (std::uint32_t column = 0; column < panel.columns; ++column)
          loop.push_back(panel.node(row, column));
        // The other panel is seen from its own outside: its left is this one's right.
        for (std::uint32_t column = 0; column < other->columns; ++column)
          loop.push_back(other->node(other_row, column));
        loops.push_back(std::move(loop));
      }
    }
  return loops;
}

/// How often a loop goes around an upright axis.
int turns_around(const std::vector<std::uint32_t>& loop, const std::vector<Vec3d>& position,
                 const Vec3d& axis) {
  double angle = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vec3d from = position[loop[i]] - axis, to = position[loop[(i + 1) % loop.size()]] - axis;
    angle += std::atan2(from.z * to.x - from.x * to.z, from.x * to.x + from.z * to.z);
  }
  return static_cast<int>(std::lround(angle / (2 * std::numbers::pi)));
}

}  // namespace

std::vector<Vec3d> face_samples(const GarmentPanel& panel, const std::vector<Vec3d>& position) {
  constexpr int per_side = 5;
  std::vector<Vec3d> samples;
  for (std::uint32_t row = 0; row + 1 < panel.rows; ++row)
    for (std::uint32_t column = 0; column + 1 < panel.columns; ++column) {
      const Vec3d &corner = position[panel.node(row, column)], &right = position[panel.node(row, column + 1)],
                  &up = position[panel.node(row + 1, column)],
                  &far = position[panel.node(row + 1, column + 1)];
      for (int i = 0; i < per_side; ++i)
        for (int j = 0; j < per_side; ++j) {
          const double u = i / (per_side - 1.0), v = j / (per_side - 1.0);
          samples.push_back(u + v <= 1 ? corner + u * (right - corner) + v * (up - corner)
                                       : far + (1 - u) * (up - far) + (1 - v) * (right - far));
        }
    }
  return samples;
}

Fit fit_of(const System& system, const std::vector<Vec3d>& position, const FitBody& body) {
  const auto& garment = std::get<Garment>(system.topology);
  Fit fit;
  fit.largest_gap = largest_gap(garment, position);
  for (const double depth : body.depths(position)) {
    fit.nodes_inside += depth > 0 ? 1U : 0U;
    fit.deepest_node = std::max(fit.deepest_node, depth);
  }
  for (const GarmentPanel& panel : garment.panels) {
    const std::vector<double> depths = body.depths(face_samples(panel, position));
    fit.deepest_face_sample = std::max(fit.deepest_face_sample, std::ranges::max(depths));
  }
  measure_side_distance(garment.close, position, body, fit);
  fit.upper_edge_rise = upper_edge_rise(garment, position);
  if (const auto meeting = where_seams_meet(garment); !meeting.empty())
    fit.meeting_rise = mean_rise(garment, position, meeting);
  for (const std::vector<std::uint32_t>& loop : sewn_rows(garment)) {
    Vec3d middle;
    for (const std::uint32_t node : loop) middle += 1 / static_cast<double>(loop.size()) * position[node];
    ++fit.rows;
    fit.rows_astray += std::abs(turns_around(loop, position, body.limb_middle(middle))) == 1 ? 0U : 1U;
  }
  const std::vector<double> longer = elongations(system, garment, position);
  fit.elongation_50 = quantile(longer, 0.5);
  fit.elongation_99 = quantile(longer, 0.99);
  fit.elongation_999 = quantile(longer, 0.999);
  fit.elongation_max = quantile(longer, 1);
  fit.crossings = count_crossings(garment, {layer_pairs(garment), {}}, position);
  return fit;
}

}  // namespace mssim
