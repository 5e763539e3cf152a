#include "garment/spec/garment_pieces.h"

#include "scene/fields/material_fields.h"
#include "scene/fields/scene_error.h"
#include "text/input_error.h"
#include "text/printable.h"

namespace mssim {
namespace {

constexpr std::uint32_t most_panels = 64, most_seams = 256, most_lines = 10'000, most_layers = 8;
constexpr std::size_t most_points = 100;  // of a boundary: they are compared with each other
constexpr double largest_length_m = 10;

void visit_boundary(FieldVisitor& fields, std::string_view key, BoundarySpec& boundary) {
  fields.object(key, Presence::required, [&](FieldVisitor& drawn) {
    constexpr std::array<std::string_view, 2> curves{"polyline", "bezier"};
    std::uint32_t curve = 0;
    drawn.choice("curve", Presence::required, curves, curve);
    boundary.is_bezier = curve == 1;
    drawn.points("points_m", 2, most_points, from(-largest_length_m, largest_length_m), boundary.points);
  });
}

void visit_piece(FieldVisitor& fields, PieceSpec& piece) {
  fields.text("name", Presence::required, piece.name);
  fields.integer("rows", piece.rows, 2, most_lines);
  fields.integer("columns", piece.columns, 2, most_lines);
  fields.integer("layer", piece.layer, 0, most_layers - 1);
  for (std::size_t edge = 0; edge < panel_edge_names.size(); ++edge)
    visit_boundary(fields, panel_edge_names[edge], piece.boundaries[edge]);
  fields.object("placement", Presence::required, [&](FieldVisitor& placement) {
    constexpr std::array<std::string_view, 2> sides{"front", "back"};
    std::uint32_t side = 0;
    placement.choice("side", Presence::required, sides, side);
    piece.behind = side == 1;
    placement.number("axis_m", piece.axis_m, from(-largest_length_m, largest_length_m));
    placement.number("distance_m", piece.distance_m, above(0, largest_length_m));
    placement.number("bend_radius_m", piece.bend_radius_m, above(0, largest_length_m));
  });
  fields.object("cloth", Presence::optional,
                [&](FieldVisitor& cloth) { visit_cloth(cloth, piece.cloth.emplace()); });
}

void visit_stretch(FieldVisitor& fields, std::string_view key, SeamStretch& stretch) {
  fields.object(key, Presence::required, [&](FieldVisitor& sewn) {
    sewn.text("panel", Presence::required, stretch.panel);
    auto edge = static_cast<std::uint32_t>(stretch.edge);
    sewn.choice("edge", Presence::required, panel_edge_names, edge);
    stretch.edge = static_cast<PanelEdge>(edge);
    sewn.number("from", stretch.from, from(0, 1));
    sewn.number("to", stretch.to, from(0, 1));
  });
}

Curve curve_of(const BoundarySpec& boundary) {
  return boundary.is_bezier ? Curve::bezier(boundary.points) : Curve(boundary.points);
}

PatternPanel panel_of(const PieceSpec& piece, const PanelCloth& cloth) {
  const auto boundary = [&](PanelEdge edge) {
    return curve_of(piece.boundaries.at(static_cast<std::size_t>(edge)));
  };
  PanelPlacement placement;
  placement.behind = piece.behind;
  placement.axis = [axis = piece.axis_m](double) { return axis; };
  placement.distance = piece.distance_m;
  placement.radius = piece.bend_radius_m;
  return {{piece.name, boundary(PanelEdge::bottom), boundary(PanelEdge::top), boundary(PanelEdge::left),
           boundary(PanelEdge::right)},
          {piece.rows, piece.columns},
          piece.cloth.value_or(cloth),
          placement,
          piece.layer};
}

}  // namespace

void visit_cloth(FieldVisitor& fields, PanelCloth& cloth) {
  fields.number("areal_density_kg_per_m2", cloth.area_density, above(0, 1e6));
  fields.number("structural_n_per_m", cloth.structural.stiffness, above(0, largest_stiffness));
  fields.number("shear_n_per_m", cloth.shear.stiffness, above(0, largest_stiffness));
  fields.number("bending_n_per_m", cloth.bending.stiffness, above(0, largest_stiffness));
  fields.number("least_mass_share", cloth.least_mass_share, from(0, 1));
  fields.object("waistband", Presence::optional, [&](FieldVisitor& band) {
    band.number("height_m", cloth.waistband.height, above(0, largest_length_m));
    band.number("stiffness_factor", cloth.waistband.stiffness_factor, above(0, 1000));
    band.number("mass_factor", cloth.waistband.mass_factor, above(0, 1000));
    band.number("seam_factor", cloth.waistband.seam_factor, above(0, 1000));
  });
}

void visit_pieces(FieldVisitor& fields, PiecesSpec& pieces) {
  fields.list("panels", Presence::required, most_panels,
              [&](FieldVisitor& element) { visit_piece(element, pieces.panels.emplace_back()); });
  fields.list("seams", Presence::optional, most_seams, [&](FieldVisitor& element) {
    Seam& seam = pieces.seams.emplace_back();
    element.text("name", Presence::required, seam.name);
    visit_stretch(element, "first", seam.first);
    visit_stretch(element, "second", seam.second);
    element.number("tolerance", seam.tolerance, from(0, 1));
  });
}

void check_pieces(const std::filesystem::path& file, const std::string& pointer, const PiecesSpec& pieces,
                  std::uint64_t most_nodes) {
  std::uint64_t nodes = 0;
  for (std::size_t i = 0; i < pieces.panels.size(); ++i) {
    const PieceSpec& piece = pieces.panels[i];
    const std::string place = pointer + "/panels/" + std::to_string(i);
    if (piece.name.empty()) refuse(file, place + "/name", "is empty: give the panel a name");
    for (std::size_t edge = 0; edge < piece.boundaries.size(); ++edge) {
      try {
        curve_of(piece.boundaries[edge]);
      } catch (const InputError& error) {
        refuse(file, place + "/" + std::string(panel_edge_names[edge]),
               "is not a valid boundary: " + printable(error.what(), 1500));
      }
    }
    nodes += std::uint64_t{piece.rows} * piece.columns;
  }
  if (nodes > most_nodes)
    refuse(file, pointer + "/panels",
           "have " + std::to_string(nodes) + " nodes in all: give panels with at most " +
               std::to_string(most_nodes));
}

void append_pieces(const PiecesSpec& pieces, const PanelCloth& cloth, GarmentPattern& pattern) {
  for (const PieceSpec& piece : pieces.panels) pattern.panels.push_back(panel_of(piece, cloth));
  pattern.seams.insert(pattern.seams.end(), pieces.seams.begin(), pieces.seams.end());
}

}  // namespace mssim
