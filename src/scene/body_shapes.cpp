#include "scene/body_shapes.h"

#include <array>
#include <stdexcept>
#include <vector>

#include "mesh/meshing.h"
#include "mesh/tetgen.h"
#include "scene/fields/fields.h"
#include "scene/scene_file.h"
#include "scene/spec/scene_spec.h"
#include "text/text.h"

namespace mssim {
namespace {

constexpr std::uint32_t most_nodes = 100'000'000;

void visit_expected(FieldVisitor& fields, BodySpec& body) {
  fields.object(
      {"expected",
       "What the mesh of this shape should have; mssim says so where another TetGen gives something else."},
      Presence::optional, [&](FieldVisitor& expected) {
        MeshSize& size = body.expected.emplace();
        expected.integer({"nodes", "Number of nodes."}, size.nodes, 4, most_nodes);
        expected.integer({"springs", "Number of unique springs, the edges of the tetrahedra."}, size.springs,
                         6, most_nodes);
      });
}

void visit_interior(FieldVisitor& fields, InteriorPoints& interior) {
  fields.object(
      {"interior", "The points inside the shape that become nodes: those of a lattice, moved at random."},
      Presence::required, [&](FieldVisitor& points) {
        points.integer({"points", "How many there are."}, interior.count, 0, 1'000'000);
        points.integer({"seed", "Seed of the random numbers."}, interior.seed, 0, 0xffff'ffff);
        points.number({"jitter", "How far a point may be moved, in lattice spacings."}, interior.jitter,
                      from(0, 0.5));
        points.number({"margin", "Smallest distance from the surface, in lattice spacings."}, interior.margin,
                      from(0, 1));
      });
}

void visit_box(FieldVisitor& fields, BodySpec& body) {
  auto& [box, interior] = body.shape.emplace<GeneratedShape<BoxShape>>();
  fields.vector({"size_m", "Length of the sides, m."}, Presence::required, box.size, above(0, 1000));
  fields.integer({"cells_x", "Squares along x."}, box.cells[0], 1, 1000);
  fields.integer({"cells_y", "Squares along y."}, box.cells[1], 1, 1000);
  fields.integer({"cells_z", "Squares along z."}, box.cells[2], 1, 1000);
  visit_interior(fields, interior);
  visit_expected(fields, body);
}

void visit_sphere(FieldVisitor& fields, BodySpec& body) {
  auto& [sphere, interior] = body.shape.emplace<GeneratedShape<SphereShape>>();
  fields.number({"radius_m", "Radius of the sphere, m."}, sphere.radius_m, above(0, 1000));
  fields.integer({"frequency", "Triangles along an edge of the icosahedron."}, sphere.frequency, 1, 1000);
  visit_interior(fields, interior);
  visit_expected(fields, body);
}

void visit_torus(FieldVisitor& fields, BodySpec& body) {
  auto& [torus, interior] = body.shape.emplace<GeneratedShape<TorusShape>>();
  fields.number({"major_radius_m", "From the centre of the ring to that of its section, m."},
                torus.major_radius_m, above(0, 1000));
  fields.number({"minor_radius_m", "Radius of the section, m."}, torus.minor_radius_m, above(0, 1000));
  fields.integer({"cells_around", "Sections along the ring."}, torus.cells_around, 3, 1000);
  fields.integer({"cells_across", "Points of a section."}, torus.cells_across, 3, 1000);
  visit_interior(fields, interior);
  visit_expected(fields, body);
}

void visit_mesh_files(FieldVisitor& fields, BodySpec& body) {
  auto& files = body.shape.emplace<MeshFiles>();
  fields.text({"node_file", "Path of the .node file, from this file's folder."}, Presence::required,
              files.node_file);
  fields.text({"ele_file", "Path of the .ele file, from this file's folder."}, Presence::required,
              files.ele_file);
  fields.number({"unit_m", "Metres in one unit of the files, m."}, files.unit_m, above(0, 1e6));
  visit_expected(fields, body);
}

void visit_surface_file(FieldVisitor& fields, BodySpec& body) {
  auto& surface = body.shape.emplace<SurfaceFile>();
  fields.text({"file", "Path of the file, from this file's folder."}, Presence::required, surface.file);
  fields.number({"unit_m", "Metres in one unit of the file, m."}, surface.unit_m, above(0, 1e6));
  fields.number({"largest_tetrahedron_m3", "No tetrahedron becomes larger than this, m^3; 0 for no limit."},
                surface.largest_tetrahedron_m3, from(0, 1e9));
  visit_expected(fields, body);
}

void visit_scene_shape(FieldVisitor& fields, BodySpec& body) {
  fields.text({"name", "The scene's name, or the path of its file, from this file's folder."},
              Presence::required, body.shape.emplace<ShapeOfScene>().name);
}

/// The TABLE of shapes, in the order of BodyShape's alternatives: the value of `shape`, its section, and what
/// names the section's fields.
struct ShapeKind {
  Field section;
  void (*visit_fields)(FieldVisitor& fields, BodySpec& body);
};
constexpr std::array<ShapeKind, 6> shape_kinds{{
    {{"box", "A box, its sides along the axes, its surface cut into squares of two triangles each."},
     visit_box},
    {{"sphere", "A sphere, its surface a finer icosahedron."}, visit_sphere},
    {{"torus", "A ring around the y axis."}, visit_torus},
    {{"tetgen", "A mesh in TetGen's files."}, visit_mesh_files},
    {{"surface", "A closed surface in an OBJ or STL file, to be filled with tetrahedra."},
     visit_surface_file},
    {{"scene", "The shape of the first body of another scene."}, visit_scene_shape},
}};
static_assert(shape_kinds.size() == std::variant_size_v<BodyShape>);

/// The scene whose shape is meant; a path that is not absolute starts at `folder`.
SceneSpec scene_of(const ShapeOfScene& shape, const std::filesystem::path& folder) {
  return find_scene(is_path_of_scene(shape.name) ? (folder / shape.name).string() : shape.name);
}

/// The body of it whose shape is meant. Throws SceneError unless it has one of its own.
const BodySpec& first_body(const ShapeOfScene& shape, const SceneSpec& scene) {
  const auto* bodies = std::get_if<BodiesSpec>(&scene.content);
  if (bodies == nullptr)
    throw SceneError("the scene \"" + printable(shape.name) +
                     "\" has no bodies whose shape could be taken: name one that has");
  if (std::holds_alternative<ShapeOfScene>(bodies->list.front().shape))
    throw SceneError("the first body of the scene \"" + printable(shape.name) +
                     "\" takes its shape from another scene: name that one");
  return bodies->list.front();
}

/// No OwnShape is that of another scene.
[[noreturn]] void throw_not_own(const ShapeOfScene& shape) {
  throw std::logic_error("the shape of the scene " + shape.name + " was not read");
}

/// How a shape becomes a mesh, one overload a kind.
struct Mesher {
  const std::filesystem::path& folder;

  template <class Solid>
  TetMesh operator()(const GeneratedShape<Solid>& shape) const {
    return shape_mesh(shape.solid, shape.interior);
  }
  TetMesh operator()(const MeshFiles& files) const {
    TetMesh mesh = read_tetgen_files(folder / files.node_file, folder / files.ele_file);
    for (Vec3d& node : mesh.nodes) node = files.unit_m * node;
    return mesh;
  }
  TetMesh operator()(const SurfaceFile& surface) const {
    return surface_mesh({folder / surface.file, surface.unit_m, surface.largest_tetrahedron_m3});
  }
  TetMesh operator()(const ShapeOfScene& shape) const { throw_not_own(shape); }
};

/// What is known of a mesh before it is made, one overload a kind. All edges of the surface stay edges of the
/// mesh, three for a point in the limit; an inner point has four at least, each of which it may share.
struct LeastCounter {
  template <class Solid>
  SceneCounts operator()(const GeneratedShape<Solid>& shape) const {
    const std::uint64_t outer = surface_point_count(shape.solid), inner = shape.interior.count;
    return {outer + inner, 3 * outer - 6 + 2 * inner};
  }
  SceneCounts operator()(const MeshFiles& /*files*/) const { return {}; }
  SceneCounts operator()(const SurfaceFile& /*surface*/) const { return {}; }
  SceneCounts operator()(const ShapeOfScene& shape) const { throw_not_own(shape); }
};

}  // namespace

void visit_shape_fields(FieldVisitor& fields, BodySpec& body) {
  std::vector<Section> sections;
  for (const ShapeKind& kind : shape_kinds)
    sections.push_back({kind.section, [&](FieldVisitor& section) { kind.visit_fields(section, body); }});
  fields.one_of({"shape", "Which of the sections says what shape the body has."}, sections);
}

OwnShape own_shape(const BodyShape& shape, const std::filesystem::path& folder) {
  const auto* other = std::get_if<ShapeOfScene>(&shape);
  if (other == nullptr) return {shape, folder, std::nullopt};
  const SceneSpec scene = scene_of(*other, folder);
  const BodySpec& body = first_body(*other, scene);
  return {body.shape, scene.file.parent_path(), body.expected};
}

std::optional<MeshSize> stated_size(const BodySpec& body, const OwnShape& shape) {
  return std::holds_alternative<ShapeOfScene>(body.shape) ? shape.stated_by_other : body.expected;
}

SceneCounts least_counts(const OwnShape& shape) { return std::visit(LeastCounter{}, shape.shape); }

TetMesh mesh_of(const OwnShape& shape) { return std::visit(Mesher{shape.folder}, shape.shape); }

}  // namespace mssim
