#include "garment/pattern/garment_build.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "geometry/geometry.h"
#include "text/text.h"

namespace mssim {
namespace {

/// m^2, of the cell whose lower left corner is `node`
double cell_area(const PanelMesh& mesh, std::size_t node) {
  const Vec3d rising = mesh.nodes[node + mesh.columns + 1] - mesh.nodes[node];
  const Vec3d falling = mesh.nodes[node + mesh.columns] - mesh.nodes[node + 1];
  return 0.5 * cross(rising, falling).z;
}

/// Calls visit(lower left node) for each cell.
template <class Visit>
void for_each_cell(const PanelMesh& mesh, Visit visit) {
  for (std::size_t row = 0; row + 1 < mesh.rows; ++row)
    for (std::size_t column = 0; column + 1 < mesh.columns; ++column) visit(mesh.node(row, column));
}

/// Smoothed depth of the body at the heights of a panel, m, nowhere less than the body's: the maximum within
/// 5 cm up and down, then its mean over the same range.
class Profile {
 public:
  Profile(const std::string& panel, const std::function<double(double)>& depth, double sign, double lowest,
          double highest)
      : start_(lowest - 2 * window * step) {
    const auto count = static_cast<std::size_t>(std::ceil((highest - start_) / step)) + 2 * window + 2;
    std::vector<double> raw(count);
    for (std::size_t i = 0; i < count; ++i) {
      const double height = std::clamp(start_ + static_cast<double>(i) * step, lowest, highest);
      raw[i] = sign * depth(height);
      if (!std::isfinite(raw[i]))
        throw InputError(panel + ": the body has the depth " + shown(raw[i]) + " m at the height " +
                         shown(height) + " m; give a body that reaches over the heights of the whole panel");
    }
    std::vector<double> widest(count);
    over_windows(raw,
                 [&](std::size_t i, auto begin, auto end) { widest[i] = *std::max_element(begin, end); });
    values_.resize(count);
    over_windows(widest, [&](std::size_t i, auto begin, auto end) {
      double sum = 0;
      for (auto value = begin; value != end; ++value) sum += *value;
      values_[i] = sum / static_cast<double>(end - begin);
    });
  }

  double at(double height) const {
    const double place = (height - start_) / step;
    const auto i = static_cast<std::size_t>(place);
    return values_[i] + (place - static_cast<double>(i)) * (values_[i + 1] - values_[i]);
  }

 private:
  static constexpr double step = 0.0025;     // m
  static constexpr std::size_t window = 20;  // steps to each side

  template <class Visit>
  static void over_windows(const std::vector<double>& values, Visit visit) {
    for (std::size_t i = 0; i < values.size(); ++i)
      visit(i, values.begin() + static_cast<std::ptrdiff_t>(i - std::min(i, window)),
            values.begin() + static_cast<std::ptrdiff_t>(std::min(i + window + 1, values.size())));
  }

  double start_;
  std::vector<double> values_;
};

/// A point of the bent panel relative to its axis.
struct BentPoint {
  double sideways;  ///< m
  double back;      ///< m, towards the body
};

/// The place of a point at distance `along` from the axis on the flat panel after bending. From `most_back`
/// towards the body on, the panel runs straight.
BentPoint bent(double along, double radius, double most_back) {
  const double steepest = std::acos(std::max(-1.0, 1 - most_back / radius));
  const double angle = std::clamp(along / radius, -steepest, steepest);
  return {radius * std::sin(angle) + (along - radius * angle), radius * (1 - std::cos(angle))};
}

/// The nodes of a stretch in the order of the seam.
struct StretchNodes {
  std::vector<std::uint32_t> nodes;
  std::vector<double> arcs;  ///< m, from the stretch's first node to each
  double drawn_length = 0;   ///< m, between its ends as drawn
};

std::string text_of(const SeamStretch& stretch) {
  return fmt::format("the {} boundary of {} from {} to {}", name_of(stretch.edge), stretch.panel,
                     shown(stretch.from), shown(stretch.to));
}

std::size_t panel_named(const std::string& where, const std::string& name,
                        std::span<const GarmentPanel> panels) {
  const auto found = std::ranges::find(panels, name, &GarmentPanel::name);
  if (found == panels.end())
    throw InputError("{}there is no panel {}; use one of {}", where, name,
                     join(mapped<std::string>(panels, &GarmentPanel::name), ", "));
  return static_cast<std::size_t>(found - panels.begin());
}

std::size_t nearest(const std::vector<double>& arcs, double arc) {
  const auto found = std::ranges::min_element(arcs, {}, [&](double at) { return std::abs(at - arc); });
  return static_cast<std::size_t>(found - arcs.begin());
}

StretchNodes nodes_of(const std::string& where, const SeamStretch& stretch,
                      std::span<const GarmentPanel> panels, std::span<const PanelMesh> meshes) {
  const std::size_t p = panel_named(where, stretch.panel, panels);
  const auto is_fraction = [](double x) { return x >= 0 && x <= 1; };
  if (!is_fraction(stretch.from) || !is_fraction(stretch.to) || stretch.from == stretch.to)
    throw InputError("{}{} is not a valid stretch; give two different fractions from 0 to 1", where,
                     text_of(stretch));
  const std::vector<double>& arcs = meshes[p].arcs_on(stretch.edge);
  const std::size_t begin = nearest(arcs, stretch.from * arcs.back());
  const std::size_t end = nearest(arcs, stretch.to * arcs.back());
  if (begin == end)
    throw InputError("{}{} has fewer than two nodes; lengthen it or give the panel more nodes", where,
                     text_of(stretch));
  const std::vector<std::size_t> on_edge = meshes[p].edge_nodes(stretch.edge);
  StretchNodes found;
  found.drawn_length = std::abs(stretch.to - stretch.from) * arcs.back();
  for (std::size_t i = begin;; begin < end ? ++i : --i) {
    found.nodes.push_back(panels[p].first_node + static_cast<std::uint32_t>(on_edge[i]));
    found.arcs.push_back(std::abs(arcs[i] - arcs[begin]));
    if (i == end) return found;
  }
}

/// A joint whose edge is at this fraction of a seam's coarser side.
Joint place_at(const StretchNodes& coarser, double fraction) {
  constexpr double near_a_node = 0.05;  // of an edge: less than the unevenness of the seam
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

/// The first node of the waistband; the number of nodes without one.
std::size_t first_of_band(const PanelMesh& mesh, const PanelMaterial& cloth) {
  return mesh.node(mesh.rows - waistband_rows(mesh, cloth.waistband), 0);
}

template <class T>
void append(std::vector<T>& all, const std::vector<T>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

/// Calls `add` with each panel or seam. Throws PatternError with the place of one that `add` refuses.
template <class Parts, class Add>
void add_each(const Parts& parts, const Add& add) {
  for (const auto& part : parts) {
    try {
      add(part);
    } catch (const InputError& error) {
      throw PatternError(error, part.where);
    }
  }
}

/// The nodes of these seams and those of the same rows within the reach, in ascending order.
CloseCloth close_cloth(const CloseSeams& close, const Garment& garment) {
  std::set<std::uint32_t> nodes;
  const auto add_beside = [&](std::uint32_t sewn) {
    const GarmentPanel& panel = garment.panel_of(sewn);
    for (std::uint32_t column = 0; column < panel.columns; ++column) {
      const std::uint32_t node = panel.node(panel.row_of(sewn), column);
      if (length(garment.flat[node] - garment.flat[sewn]) <= close.reach) nodes.insert(node);
    }
  };
  for (const Joint& joint : garment.joints) {
    if (std::ranges::find(close.seams, joint.seam) == close.seams.end()) continue;
    for (const std::uint32_t sewn : {joint.node, joint.edge_first, joint.edge_second}) add_beside(sewn);
  }
  return {{nodes.begin(), nodes.end()}, close.lowest, close.highest};
}

/// The nodes at which two of these seams or more meet, in ascending order.
std::vector<std::uint32_t> where_seams_meet(const std::vector<std::uint32_t>& seams, const Garment& garment) {
  std::map<std::uint32_t, std::set<std::uint32_t>> seams_at;
  for (const Joint& joint : garment.joints) {
    if (std::ranges::find(seams, joint.seam) == seams.end()) continue;
    seams_at[joint.node].insert(joint.seam);
    if (joint.edge_share == 0) seams_at[joint.edge_first].insert(joint.seam);
  }
  std::vector<std::uint32_t> nodes;
  for (const auto& [node, meeting] : seams_at)
    if (meeting.size() > 1) nodes.push_back(node);
  return nodes;
}

}  // namespace

void require_cloth(const std::string& panel, const PanelMaterial& cloth) {
  const auto require = [&](double value, bool zero_too, std::string_view what) {
    if (!std::isfinite(value) || value < 0 || (value == 0 && !zero_too))
      throw InputError("{}: {} is {}; give a number {} 0", panel, what, shown(value),
                       zero_too ? "not below" : "above");
  };
  const Waistband& band = cloth.waistband;
  require(cloth.area_density, false, "the cloth's area density");
  const std::array kinds{&cloth.structural, &cloth.shear, &cloth.bending};
  for (const SpringConstantInfo& constant : spring_constants)
    for (const GridSpringKind kind : {structural, shear, bending})
      require(kinds[kind]->*constant.number,
              kind != structural || constant.number != &SpringMaterial::stiffness,
              fmt::format("the {} {}", grid_spring_kinds[kind].name, constant.name));
  require(cloth.least_mass_share, true, "the nodes' least share of the mean mass");
  require(band.height, true, "the waistband's height");
  require(band.stiffness_factor, false, "the waistband's stiffness factor");
  require(band.mass_factor, false, "the waistband's mass factor");
  require(band.seam_factor, false, "the waistband's seam factor");
}

std::uint32_t waistband_rows(const PanelMesh& mesh, const Waistband& waistband) {
  if (!(waistband.height > 0)) return 0;
  const std::vector<double>&at_left = mesh.arcs_on(PanelEdge::left),
        &at_right = mesh.arcs_on(PanelEdge::right);
  constexpr double rounding = 1e-9;
  std::uint32_t rows = 1;
  while (rows < mesh.rows) {
    const std::size_t row = mesh.rows - 1 - rows;
    const double below = 0.5 * (at_left.back() - at_left[row] + at_right.back() - at_right[row]);
    if (below > waistband.height + rounding) break;
    ++rows;
  }
  return rows;
}

void append_springs(const GarmentPanel& panel, const PanelMesh& mesh, const PanelMaterial& cloth,
                    std::vector<Spring>& springs, std::vector<SpringMaterial>& materials) {
  const auto first_material = static_cast<std::uint32_t>(materials.size());
  materials.insert(materials.end(), {cloth.structural, cloth.shear, cloth.bending});
  const std::uint32_t hoop = first_material + 3;
  const std::size_t band_begin = first_of_band(mesh, cloth);
  if (band_begin < mesh.nodes.size()) {
    materials.push_back(cloth.structural);
    materials.back().stiffness *= cloth.waistband.stiffness_factor;
  }
  for (Spring spring : springs_of(GridPatch{mesh.rows, mesh.columns, 1})) {
    const bool along_a_row = spring.kind == structural && spring.second == spring.first + 1;
    spring.kind = along_a_row && spring.first >= band_begin ? hoop : first_material + spring.kind;
    spring.rest_length = static_cast<float>(length(mesh.nodes[spring.second] - mesh.nodes[spring.first]));
    spring.first += panel.first_node;
    spring.second += panel.first_node;
    springs.push_back(spring);
  }
}

std::vector<double> node_masses(const PanelMesh& mesh, const PanelMaterial& cloth) {
  std::vector<double> masses(mesh.nodes.size(), 0);
  for_each_cell(mesh, [&](std::size_t node) {
    const double fraction = 0.25 * cell_area(mesh, node) * cloth.area_density;
    for (const std::size_t corner : {node, node + 1, node + mesh.columns, node + mesh.columns + 1})
      masses[corner] += fraction;
  });
  const double mean = area_of(mesh) * cloth.area_density / static_cast<double>(masses.size());
  const std::size_t band_begin = first_of_band(mesh, cloth);
  for (std::size_t node = 0; node < masses.size(); ++node) {
    masses[node] = std::max(masses[node], cloth.least_mass_share * mean);
    if (node >= band_begin) masses[node] *= cloth.waistband.mass_factor;
  }
  return masses;
}

double area_of(const PanelMesh& mesh) {
  double area = 0;
  for_each_cell(mesh, [&](std::size_t node) { area += cell_area(mesh, node); });
  return area;
}

std::vector<Vec3d> place_panel(const std::string& panel, const PanelMesh& mesh,
                               const PanelPlacement& placement, const BodyDepth& body) {
  if (!(placement.distance > 0 && placement.radius > 0))
    throw InputError(
        "{}: it cannot be placed {} m from the body, bent with a radius of {} m; give positive lengths",
        panel, shown(placement.distance), shown(placement.radius));
  const auto [lowest, highest] = std::ranges::minmax(mesh.nodes, {}, &Vec3d::y);
  // Seen from outside, x decreases along the rows of a panel behind the body.
  const double outwards = placement.behind ? -1 : 1;
  const Profile profile(panel, placement.behind ? body.back : body.front, outwards, lowest.y, highest.y);
  std::vector<Vec3d> placed;
  placed.reserve(mesh.nodes.size());
  for (const Vec3d& node : mesh.nodes) {
    const double axis = placement.axis(node.y);
    const bool looks_inwards = outwards * node.x * axis < 0;
    constexpr double everywhere = 2;  // radii: the whole circle
    const BentPoint point =
        bent(node.x, placement.radius,
             looks_inwards ? 2.0 / 3 * placement.distance : everywhere * placement.radius);
    placed.push_back(rounded({axis + outwards * point.sideways, node.y,
                              outwards * (profile.at(node.y) + placement.distance - point.back)}));
  }
  return placed;
}

std::vector<Joint> join_seam(const Seam& seam, std::span<const GarmentPanel> panels,
                             std::span<const PanelMesh> meshes, std::uint32_t seam_index) {
  const std::string where = fmt::format("seam {}: ", seam.name);
  const StretchNodes first = nodes_of(where, seam.first, panels, meshes);
  const StretchNodes second = nodes_of(where, seam.second, panels, meshes);
  const double longer = std::max(first.drawn_length, second.drawn_length);
  if (!(std::abs(first.drawn_length - second.drawn_length) <= seam.tolerance * longer))
    throw InputError(
        "{}{} is {} m long and {} {} m; give them the same length or raise the seam's tolerance of {}", where,
        text_of(seam.first), shown(first.drawn_length), text_of(seam.second), shown(second.drawn_length),
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
      throw InputError("{}{} and {} share the node {}; use two separate stretches", where,
                       text_of(seam.first), text_of(seam.second), joint.node);
    joints.push_back(joint);
  }
  return joints;
}

System build_garment(const GarmentPattern& pattern, const BodyDepth& body) {
  System system;
  auto& garment = system.topology.emplace<Garment>();
  std::vector<PanelMesh> meshes;  // [panels]
  std::vector<double> strengths;  // [nodes] factors of the seams' force
  add_each(pattern.panels, [&](const PatternPanel& panel) {
    const std::string& name = panel.piece.name;
    if (found_in(garment.panels, name, &GarmentPanel::name))
      throw InputError(name + ": two panels have this name; rename one of them");
    require_cloth(name, panel.cloth);
    const PanelMesh& mesh = meshes.emplace_back(mesh_panel(panel.piece, panel.grid));
    garment.panels.push_back(
        {name, mesh.rows, mesh.columns, static_cast<std::uint32_t>(garment.flat.size()), panel.layer});
    strengths.resize(garment.flat.size() + first_of_band(mesh, panel.cloth), 1);
    append(garment.flat, mesh.nodes);
    strengths.resize(garment.flat.size(), panel.cloth.waistband.seam_factor);
    append(system.start.position, place_panel(name, mesh, panel.placement, body));
    append(system.node_mass, node_masses(mesh, panel.cloth));
    append_springs(garment.panels.back(), mesh, panel.cloth, system.springs, system.materials);
  });
  add_each(pattern.seams, [&](const Seam& seam) {
    std::vector<Joint> joints =
        join_seam(seam, garment.panels, meshes, static_cast<std::uint32_t>(garment.seams.size()));
    for (Joint& joint : joints) joint.strength = strengths[joint.node];
    garment.seams.push_back(seam.name);
    append(garment.joints, joints);
  });
  garment.close = close_cloth(pattern.close, garment);
  garment.crotch = where_seams_meet(pattern.crotch, garment);
  system.start.velocity.resize(system.nodes());
  return system;
}

}  // namespace mssim
