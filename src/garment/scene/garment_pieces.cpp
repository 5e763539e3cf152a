#include <array>
#include <utility>

#include "garment/scene/garment_fields.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

constexpr std::uint32_t most_panels = 64, most_seams = 256, most_layers = 8;
constexpr std::size_t most_points = 100;  // of a boundary: each is compared with each other one

void visit_boundary(FieldVisitor& fields, const Field& field, BoundarySpec& boundary) {
  fields.object(field, Presence::required, [&](FieldVisitor& drawn) {
    constexpr std::array<std::string_view, 2> curves{"polyline", "bezier"};
    visit_choice(drawn,
                 {"curve",
                  "What the points are: corners of a polyline, or end point, two control points, end point, "
                  "... of cubic Bezier segments."},
                 Presence::required, curves, boundary.is_bezier);
    drawn.points({"points_m",
                  "Points [x, y], m; y is the height at which they are worn. n Bezier segments have 3 n + 1 "
                  "points."},
                 2, most_points, from(-largest_length_m, largest_length_m), boundary.points);
  });
}

void visit_piece(FieldVisitor& fields, PieceSpec& piece) {
  fields.text({"name", "Unique name of the panel, to which seams refer."}, Presence::required, piece.name);
  fields.integer({"rows", "Rows of nodes, from the bottom boundary to the top one."}, piece.grid.rows, 2,
                 most_panel_lines);
  fields.integer({"columns", "Columns of nodes, from the left boundary to the right one."},
                 piece.grid.columns, 2, most_panel_lines);
  fields.integer({"layer", "Layer of cloth; 0 lies on the body, as jeans do."}, piece.layer, 0,
                 most_layers - 1);
  constexpr std::array<std::string_view, panel_edge_names.size()> descriptions{
      "The lower boundary, from left to right.", "The upper boundary, from left to right.",
      "The left boundary, from bottom to top.", "The right boundary, from bottom to top."};
  for (std::size_t edge = 0; edge < panel_edge_names.size(); ++edge)
    visit_boundary(fields, {panel_edge_names[edge], descriptions.at(edge)}, piece.boundaries[edge]);
  fields.object({"placement", "Where the panel starts, at the heights at which it is drawn."},
                Presence::required, [&](FieldVisitor& placement) {
                  constexpr std::array<std::string_view, 2> sides{"front", "back"};
                  visit_choice(placement, {"side", "In front of the body or behind it."}, Presence::required,
                               sides, piece.placement.behind);
                  double axis = 0;
                  placement.number({"axis_m", "x of the drawing's x = 0, m."}, axis,
                                   from(-largest_length_m, largest_length_m));
                  piece.placement.axis = [axis](double) { return axis; };
                  placement.number(
                      {"distance_m", "Distance from the body's foremost (hindmost) point at each height, m."},
                      piece.placement.distance, above(0, largest_length_m));
                  placement.number(
                      {"bend_radius_m", "Radius of the vertical cylinder around which the panel is bent, m."},
                      piece.placement.radius, above(0, largest_length_m));
                });
  fields.object({"cloth", "Cloth of this panel, instead of the garment's."}, Presence::optional,
                [&](FieldVisitor& cloth) { visit_cloth(cloth, piece.cloth.emplace()); });
}

void visit_stretch(FieldVisitor& fields, const Field& field, SeamStretch& stretch) {
  fields.object(field, Presence::required, [&](FieldVisitor& sewn) {
    sewn.text({"panel", "Name of the panel; jeans have front left, back left, front right and back right."},
              Presence::required, stretch.panel);
    visit_choice(sewn, {"edge", "Boundary of the panel."}, Presence::required, panel_edge_names,
                 stretch.edge);
    sewn.number({"from", "Start of the stretch, as a fraction of the boundary's length."}, stretch.from,
                from(0, 1));
    sewn.number(
        {"to", "End of the stretch, as such a fraction; if it is less than from, the stretch is reversed."},
        stretch.to, from(0, 1));
  });
}

Curve curve_of(const BoundarySpec& boundary) {
  return boundary.is_bezier ? Curve::bezier(boundary.points) : Curve(boundary.points);
}

/// The JSON pointer to a garment's pieces in its scene file.
std::string pieces_pointer(const GarmentSpec& garment) {
  return garment.jeans ? "/garment/outfit" : "/garment/pieces";
}

PatternPanel panel_of(const PieceSpec& piece, const PanelMaterial& cloth, std::string where) {
  const auto& [bottom, top, left, right] = piece.boundaries;  // by PanelEdge
  return {{piece.name, curve_of(bottom), curve_of(top), curve_of(left), curve_of(right)},
          piece.grid,
          piece.cloth.value_or(cloth),
          piece.placement,
          piece.layer,
          std::move(where)};
}

}  // namespace

void visit_cloth(FieldVisitor& fields, PanelMaterial& cloth) {
  fields.number({"areal_density_kg_per_m2", "Mass per area, kg/m^2."}, cloth.area_density, from(1e-6, 1e6));
  fields.number(
      {"structural_n_per_m", "Stiffness of the springs between neighbours in a row or column, N/m."},
      cloth.structural.stiffness, above(0, largest_stiffness));
  fields.number({"shear_n_per_m", "Stiffness of the springs along the diagonals of cells, N/m."},
                cloth.shear.stiffness, above(0, largest_stiffness));
  fields.number(
      {"bending_n_per_m", "Stiffness of the springs to the second next node in a row or column, N/m."},
      cloth.bending.stiffness, above(0, largest_stiffness));
  fields.number({"least_mass_share",
                 "Least mass of a node over the mean of its panel, without unit: nodes on the boundary have "
                 "less cloth."},
                cloth.least_mass_share, from(0, 1));
  fields.object({"waistband", "The rows next to the upper edge, which hold the garment on the body."},
                Presence::optional, [&](FieldVisitor& band) {
                  band.number({"height_m", "Height of the band, m."}, cloth.waistband.height,
                              above(0, largest_length_m));
                  band.number({"stiffness_factor",
                               "Factor of the stiffness of the springs along the rows, without unit."},
                              cloth.waistband.stiffness_factor, above(0, 1000));
                  band.number({"mass_factor", "Factor of the masses of its nodes, without unit."},
                              cloth.waistband.mass_factor, above(0, 1000));
                  band.number({"seam_factor", "Factor of the force of the seams, without unit."},
                              cloth.waistband.seam_factor, above(0, 1000));
                });
}

void visit_pieces(FieldVisitor& fields, PiecesSpec& pieces) {
  fields.list({"panels", "The panels."}, Presence::required, most_panels,
              "A panel: a grid of nodes on a pattern piece between four boundaries, drawn as seen from "
              "outside when worn.",
              [&](FieldVisitor& panel) { visit_piece(panel, pieces.panels.emplace_back()); });
  fields.list(
      {"seams", "The seams; without this field, nothing is sewn."}, Presence::optional, most_seams,
      "Two stretches of boundaries that are sewn together, start to start.", [&](FieldVisitor& element) {
        Seam& seam = pieces.seams.emplace_back();
        element.text({"name", "Name of the seam, for messages."}, Presence::required, seam.name);
        visit_stretch(element, {"first", "One of the two stretches."}, seam.first);
        visit_stretch(element, {"second", "The other stretch."}, seam.second);
        element.number({"tolerance", "Largest difference of their lengths, as a fraction of the longer one."},
                       seam.tolerance, from(0, 1));
      });
}

void check_pieces(const SceneSpec& spec) {
  const GarmentSpec& garment = garment_of(spec);
  if (!garment.pieces) return;
  const std::string pointer = pieces_pointer(garment);
  std::uint64_t nodes = 0;
  for (std::size_t i = 0; i < garment.pieces->panels.size(); ++i) {
    const PieceSpec& piece = garment.pieces->panels[i];
    const std::string place = fmt::format("{}/panels/{}", pointer, i);
    if (piece.name.empty()) refuse(spec.file, place + "/name", "is empty: give the panel a name");
    for (std::size_t edge = 0; edge < piece.boundaries.size(); ++edge)
      refusing<InputError>(spec.file, fmt::format("{}/{}", place, panel_edge_names[edge]),
                           "is not a valid boundary", [&] { curve_of(piece.boundaries[edge]); });
    nodes += std::uint64_t{piece.grid.rows} * piece.grid.columns;
  }
  if (nodes > most_garment_nodes)
    refuse(spec.file, pointer + "/panels",
           fmt::format("have {} nodes in all: give panels with at most {}", nodes, most_garment_nodes));
}

void append_pieces(const GarmentSpec& garment, GarmentPattern& pattern) {
  if (!garment.pieces) return;
  const auto& [panels, seams] = *garment.pieces;
  const std::string pointer = pieces_pointer(garment);
  for (std::size_t i = 0; i < panels.size(); ++i)
    pattern.panels.push_back(panel_of(panels[i], garment.cloth, fmt::format("{}/panels/{}", pointer, i)));
  for (std::size_t i = 0; i < seams.size(); ++i)
    pattern.seams.emplace_back(seams[i]).where = fmt::format("{}/seams/{}", pointer, i);
}

}  // namespace mssim
