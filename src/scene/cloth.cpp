#include <fmt/core.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "scene/builders.h"
#include "scene/fields/fields.h"
#include "scene/spec/scene_spec.h"

namespace mssim {
namespace {

/// Largest height of the ripple over its wavelength. The displacement u in the plane has a gradient of at
/// most sqrt(2) ripple_in_plane_share height 2 pi / wavelength in the Frobenius norm; below 1 no two nodes
/// can coincide, and at this slope it is 0.44.
constexpr double steepest_ripple = 0.1;

const ClothSpec& cloth_of(const SceneSpec& spec) { return std::get<ClothSpec>(spec.content); }

void visit_springs(FieldVisitor& fields, ClothSpec& cloth) {
  constexpr std::array<std::string_view, grid_spring_kinds.size()> descriptions{
      "Springs between neighbours.", "Springs across the diagonals.", "Springs between nodes two apart."};
  for (std::size_t kind = 0; kind < grid_spring_kinds.size(); ++kind) {
    // Structural springs hold the cloth together; the other two kinds are optional.
    const Range stiffness = kind == structural ? above(0, largest_stiffness) : from(0, largest_stiffness);
    fields.object({grid_spring_kinds[kind].name, descriptions.at(kind)}, Presence::required,
                  [&](FieldVisitor& material) { visit_material(material, cloth.springs[kind], stiffness); });
  }
}

bool is_pinned(const ClothSpec& cloth, std::uint32_t row, std::uint32_t column) {
  return cloth.pins && row == cloth.pins->row &&
         (column % cloth.pins->every_columns == 0 || column + 1 == cloth.columns);
}

/// The standing wave of the ripple. Each of its six components is the product of a sine of the column and one
/// of the row, which are tabulated: 16 million nodes need only 48,000 sines.
class Ripple {
 public:
  explicit Ripple(const ClothSpec& cloth)
      : columns_(sines(cloth, cloth.columns, 0)), rows_(sines(cloth, cloth.rows, 1)) {}

  /// Three components, starting with number `first`.
  Vec3d at(std::uint32_t row, std::uint32_t column, std::size_t first) const {
    const auto &x = columns_[column], &z = rows_[row];
    return {x[first] * z[first], x[first + 1] * z[first + 1], x[first + 2] * z[first + 2]};
  }
  static constexpr std::size_t position = 0, velocity = 3;

 private:
  static constexpr std::size_t components = ripple_phases.size();
  using Sines = std::vector<std::array<double, components>>;
  static Sines sines(const ClothSpec& cloth, std::uint32_t count, std::size_t axis) {
    const double wave_number = 2 * std::numbers::pi / cloth.ripple.wavelength_m;
    Sines result(count);
    for (std::uint32_t i = 0; i < count; ++i)
      for (std::size_t c = 0; c < components; ++c)
        result[i][c] = std::sin(wave_number * (i * cloth.spacing_m) + ripple_phases[c][axis]);
    return result;
  }

  Sines columns_, rows_;
};

SceneCounts cloth_counts(const SceneSpec& spec) {
  const ClothSpec& cloth = cloth_of(spec);
  const std::uint64_t springs = count_springs(cloth.rows, cloth.columns);
  return {std::uint64_t{cloth.rows} * cloth.columns, springs};
}

void visit_fields(FieldVisitor& fields, SceneSpec& spec) {
  ClothSpec& cloth = spec.content.emplace<ClothSpec>();
  fields.integer({"rows", "Number of rows (along z); rows times columns must be below 2^32."}, cloth.rows, 2,
                 1'000'000);
  fields.integer({"columns", "Number of columns (along x)."}, cloth.columns, 2, 1'000'000);
  fields.number({"spacing_m", "Distance of neighbours at rest, m."}, cloth.spacing_m, from(1e-6, 100));
  fields.number(
      {"areal_density_kg_per_m2", "Mass per area, kg/m^2; a node weighs this times the spacing squared."},
      cloth.areal_density_kg_per_m2, from(1e-6, 1e6));
  fields.number({"ceiling_height_m", "Height at which the cloth starts and is pinned, m."},
                cloth.ceiling_height_m, from(-1e6, 1e6));
  fields.object(
      {"pins", "The nodes that keep their start position. Without this section the cloth falls freely."},
      Presence::optional, [&](FieldVisitor& section) {
        ClothPins& pins = cloth.pins.emplace();
        section.integer({"row", "The pinned row, counted from 0."}, pins.row, 0, 999'999);
        section.integer(
            {"every_columns",
             "Columns from one pinned node to the next, from column 0 on; the last column is pinned, too."},
            pins.every_columns, 1, 1'000'000);
      });
  fields.object(
      {"ripple",
       "A standing wave at the start, so that all springs act and all nodes move from the first step."},
      Presence::required, [&ripple = cloth.ripple](FieldVisitor& section) {
        section.number(
            {"height_m", "Amplitude of the vertical displacement, m; within the plane it is half as large."},
            ripple.height_m, from(0, 100));
        section.number({"wavelength_m", "Wavelength along x and along z, m."}, ripple.wavelength_m,
                       from(1e-6, 1e6));
        section.number({"speed_m_per_s", "Amplitude of each component of the velocity, m/s."},
                       ripple.speed_m_per_s, from(0, 1000));
      });
  fields.object({"springs", "Stiffness and damping of each kind of spring."}, Presence::required,
                [&](FieldVisitor& springs) { visit_springs(springs, cloth); });
}

/// The nodes can be numbered, the pinned row exists, the cloth starts above the floor, and the ripple
/// compresses no spring to length zero.
void check(const SceneSpec& spec) {
  const ClothSpec& cloth = cloth_of(spec);
  constexpr std::uint64_t largest = std::numeric_limits<std::uint32_t>::max();
  if (const std::uint64_t nodes = std::uint64_t{cloth.rows} * cloth.columns; nodes > largest)
    refuse(spec.file, "/cloth/rows",
           fmt::format("is {}, which with {} columns makes {} nodes: keep the product at or below {}",
                       cloth.rows, cloth.columns, nodes, largest));
  if (cloth.pins && cloth.pins->row >= cloth.rows)
    refuse(spec.file, "/cloth/pins/row",
           fmt::format("is {}, but the rows are numbered from 0 to {}: name one of them", cloth.pins->row,
                       cloth.rows - 1));
  const double lowest_start = cloth.ceiling_height_m - cloth.ripple.height_m;
  if (!(lowest_start > spec.floor.height))
    refuse(spec.file, "/cloth/ceiling_height_m",
           "is " + shown_number(cloth.ceiling_height_m) + ", so the ripple would start at " +
               shown_number(lowest_start) + ", not above the floor at " + shown_number(spec.floor.height) +
               ": raise it or lower /floor/height_m");
  if (cloth.ripple.height_m > steepest_ripple * cloth.ripple.wavelength_m)
    refuse(spec.file, "/cloth/ripple/height_m",
           "is " + shown_number(cloth.ripple.height_m) +
               ", more than a tenth of the wavelength, and could fold springs: give at most " +
               shown_number(steepest_ripple * cloth.ripple.wavelength_m) +
               " or raise /cloth/ripple/wavelength_m");
  if (cloth.pins && cloth.ripple.height_m > cloth.spacing_m)
    refuse(spec.file, "/cloth/ripple/height_m",
           "is " + shown_number(cloth.ripple.height_m) +
               ", more than the spacing, and could fold springs at the pins: give at most " +
               shown_number(cloth.spacing_m) + " or remove /cloth/pins");
}

}  // namespace

System outline_of_cloth(const SceneSpec& spec) {
  const ClothSpec& cloth = cloth_of(spec);
  System system;
  set_laws(system, spec);
  system.topology = GridPatch{cloth.rows, cloth.columns, cloth.spacing_m};
  system.materials.assign(cloth.springs.begin(), cloth.springs.end());
  return system;
}

System build_cloth_window(const SceneSpec& spec, const GridWindow& window) {
  const ClothSpec& cloth = cloth_of(spec);
  System system = outline_of_cloth(spec);
  const GridPatch grid{window.rows, window.columns, cloth.spacing_m, window.column};
  system.topology = grid;
  system.node_mass.assign(grid.nodes(), cloth.areal_density_kg_per_m2 * cloth.spacing_m * cloth.spacing_m);

  const Ripple ripple(cloth);
  const double height = cloth.ripple.height_m, speed = cloth.ripple.speed_m_per_s;
  system.start.position.reserve(grid.nodes());
  system.start.velocity.reserve(grid.nodes());
  for (std::uint32_t row = window.row; row < window.row + window.rows; ++row)
    for (std::uint32_t column = window.column; column < window.column + window.columns; ++column) {
      Vec3d position{column * cloth.spacing_m, cloth.ceiling_height_m, row * cloth.spacing_m};
      Vec3d velocity;
      if (is_pinned(cloth, row, column)) {
        system.pins.push_back(grid.node(row - window.row, column - window.column));
      } else {
        velocity = speed * ripple.at(row, column, Ripple::velocity);
        const Vec3d wave = ripple.at(row, column, Ripple::position);
        position += height * Vec3d{ripple_in_plane_share * wave.x, wave.y, ripple_in_plane_share * wave.z};
      }
      system.start.add(position, velocity);
    }
  return system;
}

System build_cloth(const SceneSpec& spec) {
  const ClothSpec& cloth = cloth_of(spec);
  System system = build_cloth_window(spec, {.rows = cloth.rows, .columns = cloth.columns});
  system.springs = springs_of(std::get<GridPatch>(system.topology));
  return system;
}

const SceneKind ClothSpec::kind{
    .name = "cloth",
    .description =
        "A regular cloth, level at first: row r, column c starts at (c spacing, ceiling height, r spacing). "
        "Neighbours are joined by structural springs, diagonal ones by shear springs, those two apart by "
        "bending springs.",
    .visit_fields = visit_fields,
    .check = check,
    // The published counts include the 12-neighbour stencil of every node, and so each spring from both of
    // its ends.
    .published_per_spring = 2,
    .stated = [](const SceneSpec& spec) { return std::optional(cloth_counts(spec)); },
    .read =
        [](const SceneSpec& spec) {
          return SceneParts{cloth_counts(spec),
                            [](const SceneSpec& of) { return BuiltScene{build_cloth(of)}; }};
        },
};

}  // namespace mssim
