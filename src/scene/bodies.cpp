#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "geometry/geometry.h"
#include "mesh/meshing.h"
#include "mesh/tetgen.h"
#include "platform/machine.h"
#include "scene/builders.h"
#include "scene/fields/fields.h"
#include "scene/scene_file.h"
#include "scene/scene_kinds.h"
#include "scene/spec/scene_spec.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

constexpr std::uint32_t most_nodes = 100'000'000;

void visit_expected(FieldVisitor& fields, BodySpec& body) {
  fields.object(
      {"expected", "Expected size of this shape's mesh; mssim reports if another TetGen gives another size."},
      Presence::optional, [&](FieldVisitor& expected) {
        MeshSize& size = body.expected.emplace();
        expected.integer({"nodes", "Number of nodes."}, size.nodes, 4, most_nodes);
        expected.integer({"springs", "Number of unique springs, the edges of the tetrahedra."}, size.springs,
                         6, most_nodes);
      });
}

void visit_interior(FieldVisitor& fields, InteriorPoints& interior) {
  fields.object(
      {"interior", "The points inside the shape that become nodes: a lattice, perturbed at random."},
      Presence::required, [&](FieldVisitor& points) {
        points.integer({"points", "Number of points."}, interior.count, 0, 1'000'000);
        points.integer({"seed", "Seed of the random numbers."}, interior.seed, 0, 0xffff'ffff);
        points.number({"jitter", "Maximum perturbation of a point, in lattice spacings."}, interior.jitter,
                      from(0, 0.5));
        points.number({"margin", "Smallest distance from the surface, in lattice spacings."}, interior.margin,
                      from(0, 1));
      });
}

void visit_box(FieldVisitor& fields, BodySpec& body) {
  auto& [solid, interior] = body.shape.emplace<GeneratedShape>();
  auto& box = solid.emplace<BoxShape>();
  fields.vector({"size_m", "Length of the sides, m."}, Presence::required, box.size, above(0, 1000));
  fields.integer({"cells_x", "Squares along x."}, box.cells[0], 1, 1000);
  fields.integer({"cells_y", "Squares along y."}, box.cells[1], 1, 1000);
  fields.integer({"cells_z", "Squares along z."}, box.cells[2], 1, 1000);
  visit_interior(fields, interior);
}

void visit_sphere(FieldVisitor& fields, BodySpec& body) {
  auto& [solid, interior] = body.shape.emplace<GeneratedShape>();
  auto& sphere = solid.emplace<SphereShape>();
  fields.number({"radius_m", "Radius of the sphere, m."}, sphere.radius_m, above(0, 1000));
  fields.integer({"frequency", "Triangles along an edge of the icosahedron."}, sphere.frequency, 1, 1000);
  visit_interior(fields, interior);
}

void visit_torus(FieldVisitor& fields, BodySpec& body) {
  auto& [solid, interior] = body.shape.emplace<GeneratedShape>();
  auto& torus = solid.emplace<TorusShape>();
  fields.number({"major_radius_m", "Distance from the centre of the ring to that of its section, m."},
                torus.major_radius_m, above(0, 1000));
  fields.number({"minor_radius_m", "Radius of the section, m."}, torus.minor_radius_m, above(0, 1000));
  fields.integer({"cells_around", "Sections along the ring."}, torus.cells_around, 4, 1000);
  fields.integer({"cells_across", "Points of a section."}, torus.cells_across, 3, 1000);
  visit_interior(fields, interior);
}

void visit_mesh_files(FieldVisitor& fields, BodySpec& body) {
  auto& files = body.shape.emplace<MeshFiles>();
  fields.text({"node_file", "Path of the .node file, from this file's folder."}, Presence::required,
              files.node_file);
  fields.text({"ele_file", "Path of the .ele file, from this file's folder."}, Presence::required,
              files.ele_file);
  fields.number({"unit_m", "Metres in one unit of the files, m."}, files.unit_m, above(0, 1e6));
}

void visit_surface_file(FieldVisitor& fields, BodySpec& body) {
  auto& surface = body.shape.emplace<SurfaceFile>();
  fields.text({"file", "Path of the file, from this file's folder."}, Presence::required, surface.file);
  fields.number({"unit_m", "Metres in one unit of the file, m."}, surface.unit_m, above(0, 1e6));
  fields.number({"largest_tetrahedron_m3", "No tetrahedron becomes larger than this, m^3; 0 for no limit."},
                surface.largest_tetrahedron_m3, from(0, 1e9));
}

void visit_scene_shape(FieldVisitor& fields, BodySpec& body) {
  fields.text({"name", "The scene's name, or the path of its file, from this file's folder."},
              Presence::required, body.shape.emplace<ShapeOfScene>().name);
}

/// The TABLE of shapes: value of `shape`, its section, and the function that names the section's fields.
struct ShapeKind {
  Field section;
  void (*visit_fields)(FieldVisitor& fields, BodySpec& body);
};
constexpr auto shape_kinds = std::to_array<ShapeKind>({
    {{"box", "A box, its sides along the axes, its surface cut into squares of two triangles each."},
     visit_box},
    {{"sphere", "A sphere, its surface a finer icosahedron."}, visit_sphere},
    {{"torus", "A ring around the y axis."}, visit_torus},
    {{"tetgen", "A mesh in TetGen's files."}, visit_mesh_files},
    {{"surface", "A closed surface in an OBJ or STL file, to be filled with tetrahedra."},
     visit_surface_file},
    {{"scene", "The shape of the first body of another scene."}, visit_scene_shape},
});
static_assert(shape_kinds.size() == std::variant_size_v<Shape> + std::variant_size_v<BodyShape> - 1);

/// A shape with the reference to another scene resolved.
struct OwnShape {
  BodyShape shape;
  std::filesystem::path folder;             ///< base of the paths of its files
  std::optional<MeshSize> stated_by_other;  ///< size of the mesh that the other scene states
  std::filesystem::path other;              ///< the file of that scene; empty if there is none
};

/// The shape of a body in a scene file of that folder. If it refers to another scene, that one is read;
/// throws SceneError if there is no such scene or its first body has no shape of its own.
OwnShape own_shape(const BodyShape& shape, const std::filesystem::path& folder) {
  const auto* other = std::get_if<ShapeOfScene>(&shape);
  if (other == nullptr) return {shape, folder, std::nullopt, {}};
  const std::string& name = other->name;
  const SceneSpec scene = find_scene(is_path_of_scene(name) ? (folder / name).string() : name);
  const auto* bodies = std::get_if<BodiesSpec>(&scene.content);
  if (bodies == nullptr)
    throw SceneError("the scene \"{}\" has no bodies whose shape could be used: name another scene",
                     printable(name));
  const BodySpec& body = bodies->list.front();
  if (std::holds_alternative<ShapeOfScene>(body.shape))
    throw SceneError("the first body of the scene \"{}\" takes its shape from another scene: name that scene",
                     printable(name));
  return {body.shape, scene.file.parent_path(), body.expected, scene.file};
}

/// Makes the mesh of a shape.
TetMesh mesh_of(const OwnShape& own) {
  if (const auto* generated = std::get_if<GeneratedShape>(&own.shape)) return shape_mesh(*generated);
  if (const auto* surface = std::get_if<SurfaceFile>(&own.shape))
    return surface_mesh({own.folder / surface->file, surface->unit_m, surface->largest_tetrahedron_m3});
  const auto& files = std::get<MeshFiles>(own.shape);  // own_shape has resolved references to other scenes
  TetMesh mesh = read_tetgen_files(own.folder / files.node_file, own.folder / files.ele_file);
  for (Vec3d& node : mesh.nodes) node = files.unit_m * node;
  return mesh;
}

/// Lower bounds on a mesh before it is made. All edges of a generated surface are edges of the mesh, in the
/// limit three per point; an inner point has at least four, each possibly shared.
SceneCounts least_counts(const OwnShape& own) {
  const auto* shape = std::get_if<GeneratedShape>(&own.shape);
  if (shape == nullptr) return {};
  const std::uint64_t all = point_count(*shape), inner = shape->interior.count;
  return {all, 3 * (all - inner) - 6 + 2 * inner};
}

constexpr std::size_t most_bodies = 10'000;

/// Range of lengths of a body's springs, m. Within it, lengths, masses and stiffnesses over masses are normal
/// numbers in single precision.
constexpr double shortest_spring = 1e-7, longest_spring = 1e6;

const BodiesSpec& bodies_of(const SceneSpec& spec) { return std::get<BodiesSpec>(spec.content); }

void visit_body(FieldVisitor& fields, BodySpec& body) {
  std::vector<Section> shapes;
  for (const ShapeKind& kind : shape_kinds)
    shapes.push_back({kind.section, [&](FieldVisitor& section) {
                        kind.visit_fields(section, body);
                        if (!std::holds_alternative<ShapeOfScene>(body.shape)) visit_expected(section, body);
                      }});
  fields.one_of({"shape", "The section that describes the body's shape."}, shapes);
  fields.vector({"centre_m", "Start of the centre of mass, [x, y, z], m."}, Presence::required, body.centre_m,
                from(-1e6, 1e6));
  fields.object({"turn", "Rotation of the shape about its centre at the start."}, Presence::optional,
                [&](FieldVisitor& turn) {
                  turn.vector({"axis", "Direction of the axis, of any nonzero length."}, Presence::required,
                              body.turn_axis, from(-1, 1));
                  turn.number({"angle_deg", "Angle, degrees."}, body.turn_deg, from(-360, 360));
                });
  fields.vector({"velocity_m_per_s", "Velocity of the centre at the start, m/s."}, Presence::required,
                body.velocity_m_per_s, from(-1000, 1000));
  fields.vector({"spin_rad_per_s", "Angular velocity about the centre at the start, rad/s."},
                Presence::required, body.spin_rad_per_s, from(-1000, 1000));
  fields.number(
      {"swell_per_s",
       "Initial growth rate of the body, 1/s, so that every spring is active from the first step on."},
      body.swell_per_s, from(-100, 100));
}

std::string pointer_to(std::size_t body) { return fmt::format("/bodies/list/{}", body); }

/// A shape of bodies: its mesh and quantities derived from it.
struct MeshedShape {
  std::size_t first_body;  ///< first body that has it
  OwnShape own;
  TetMesh mesh = {};  ///< its centre is the origin
  std::vector<std::array<std::uint32_t, 2>> edges = {};
  double volume = 0;  ///< m^3
};

/// The size of a body's mesh that its scene states, or the scene that has its shape; nothing if neither does.
std::optional<MeshSize> stated_size(const BodySpec& body, const OwnShape& own) {
  return own.other.empty() ? body.expected : own.stated_by_other;
}

/// Throws SceneError if the shape of another scene cannot be used.
OwnShape shape_of(const SceneSpec& spec, std::size_t body) {
  return refusing<SceneError>(spec.file, pointer_to(body), "has no mesh", [&] {
    return own_shape(bodies_of(spec).list[body].shape, spec.file.parent_path());
  });
}

void require_lengths(const MeshedShape& shape, const SceneSpec& spec) {
  for (const auto& [a, b] : shape.edges)
    if (const double metres = length(shape.mesh.nodes[b] - shape.mesh.nodes[a]);
        !(metres >= shortest_spring && metres <= longest_spring))
      refuse(spec.file, pointer_to(shape.first_body),
             "has a spring of " + shown(metres) + " m: springs are from " + shown_number(shortest_spring) +
                 " to " + shown_number(longest_spring) + " m long, so correct the unit_m or the mesh");
}

void mesh(MeshedShape& shape, const SceneSpec& spec) {
  shape.mesh = refusing<InputError>(spec.file, pointer_to(shape.first_body), "has no mesh",
                                    [&] { return mesh_of(shape.own); });
  Vec3d centre;
  for (const Vec3d& node : shape.mesh.nodes) centre += node;
  centre = 1 / static_cast<double>(shape.mesh.nodes.size()) * centre;
  for (Vec3d& node : shape.mesh.nodes) node -= centre;
  shape.edges = edges_of(shape.mesh);
  require_lengths(shape, spec);
  shape.volume = volume_of(shape.mesh);
}

/// The shapes of a scene's bodies, each read and meshed once.
class MeshedShapes {
 public:
  /// Throws SceneError, before meshing if the memory does not suffice, and MissingProgram.
  explicit MeshedShapes(const SceneSpec& spec) {
    const std::vector<BodySpec>& list = bodies_of(spec).list;
    for (std::size_t body = 0; body < list.size(); ++body) {
      const auto known = std::ranges::find_if(shapes_, [&](const MeshedShape& shape) {
        return list[shape.first_body].shape == list[body].shape;
      });
      of_body_.push_back(static_cast<std::size_t>(known - shapes_.begin()));
      if (known == shapes_.end()) shapes_.push_back({body, shape_of(spec, body)});
    }
    require_memory_for_meshes(spec);
    for (MeshedShape& shape : shapes_) mesh(shape, spec);
  }

  const MeshedShape& of_body(std::size_t body) const { return shapes_[of_body_[body]]; }

  /// Nodes and springs of all bodies.
  SceneCounts counts() const {
    SceneCounts counts;
    for (const std::size_t shape : of_body_) {
      counts.nodes += shapes_[shape].mesh.nodes.size();
      counts.springs_unique += shapes_[shape].edges.size();
    }
    return counts;
  }

  /// The files of all shapes.
  std::vector<std::filesystem::path> files() const {
    std::vector<std::filesystem::path> files;
    for (const MeshedShape& shape : shapes_) {
      const OwnShape& own = shape.own;
      if (!own.other.empty()) files.push_back(own.other);
      if (const auto* surface = std::get_if<SurfaceFile>(&own.shape))
        files.push_back(own.folder / surface->file);
      if (const auto* tetgen = std::get_if<MeshFiles>(&own.shape))
        files.insert(files.end(), {own.folder / tetgen->node_file, own.folder / tetgen->ele_file});
    }
    return files;
  }

  /// Hash of all meshes.
  std::uint64_t hash() const {
    std::uint64_t all = fnv1a_64("");
    for (const MeshedShape& shape : shapes_)
      all = fnv1a_64(bytes_of(shape.mesh.tetrahedra), fnv1a_64(bytes_of(shape.mesh.nodes), all));
    return all;
  }

  /// Which mesh has another size than is stated, and how the meshes were made, if a reader should know:
  /// sentences, or empty. A scene may have thousands of bodies, so the sentence names only the first.
  std::string note(const SceneSpec& spec) const {
    std::string all;
    std::size_t other_meshes = 0;
    for (std::size_t body = 0; body < of_body_.size(); ++body) {
      const MeshedShape& shape = of_body(body);
      const MeshSize made{static_cast<std::uint32_t>(shape.mesh.nodes.size()),
                          static_cast<std::uint32_t>(shape.edges.size())};
      const std::optional<MeshSize> stated = stated_size(bodies_of(spec).list[body], shape.own);
      if (!stated || *stated == made) continue;
      if (++other_meshes == 1)
        all = fmt::format(
            "the mesh of {} has {} nodes and {} springs where the scene states {} and {}: another TetGen, or "
            "another file, makes another mesh",
            pointer_to(body), made.nodes, made.springs, stated->nodes, stated->springs);
    }
    if (other_meshes > 1)
      append_sentence(all, fmt::format("{} bodies in all have another mesh", other_meshes));
    for (const MeshedShape& shape : shapes_) append_sentence(all, shape.mesh.note);
    return all;
  }

 private:
  /// Meshing takes minutes for millions of nodes, so scenes that do not fit in memory are refused before.
  void require_memory_for_meshes(const SceneSpec& spec) const {
    SceneCounts least;
    for (const std::size_t shape : of_body_) {
      const SceneCounts body = least_counts(shapes_[shape].own);
      least.nodes += body.nodes;
      least.springs_unique += body.springs_unique;
    }
    if (const auto shortage = memory_shortage(memory_needed(least)))
      refuse(spec.file, "/bodies",
             "has at least " + std::to_string(least.nodes) + " nodes and " +
                 std::to_string(least.springs_unique) + " springs and " + *shortage +
                 ": give fewer bodies, or bodies of fewer cells or points");
  }

  std::vector<MeshedShape> shapes_;
  std::vector<std::size_t> of_body_;  ///< [bodies] the index of its shape
};

double longest_part(const Vec3d& r) { return std::max({std::abs(r.x), std::abs(r.y), std::abs(r.z)}); }

/// The unit vector along `axis`, which may be so short that its square is 0.
Vec3d direction_of(const Vec3d& axis) {
  constexpr double surely_not_too_short = 1e-6;
  if (const double l = length(axis); l > surely_not_too_short) return 1 / l * axis;
  const double longest = longest_part(axis);
  const Vec3d longer{axis.x / longest, axis.y / longest, axis.z / longest};
  return 1 / length(longer) * longer;
}

/// Rodrigues' rotation by `angle` (radians) about the unit vector `axis`.
Vec3d turned(const Vec3d& r, const Vec3d& axis, double angle) {
  const double c = std::cos(angle);
  return c * r + std::sin(angle) * cross(axis, r) + (1 - c) * dot(axis, r) * axis;
}

void add_body(System& system, std::vector<Tetrahedron>& tetrahedra, const MeshedShape& shape,
              const BodiesSpec& bodies, const BodySpec& body) {
  const auto first = static_cast<std::uint32_t>(system.nodes());
  const Vec3d axis = direction_of(body.turn_axis);
  for (const Vec3d& node : shape.mesh.nodes) {
    const Vec3d r = turned(node, axis, body.turn_deg * std::numbers::pi / 180);
    system.start.add(body.centre_m + r,
                     body.velocity_m_per_s + cross(body.spin_rad_per_s, r) + body.swell_per_s * r);
  }
  for (const auto& [a, b] : shape.edges)
    system.springs.push_back(
        {first + a, first + b, static_cast<float>(length(shape.mesh.nodes[b] - shape.mesh.nodes[a])), 0});
  for (Tetrahedron corners : shape.mesh.tetrahedra) {
    for (std::uint32_t& corner : corners) corner += first;
    tetrahedra.push_back(corners);
  }
  const std::size_t nodes = shape.mesh.nodes.size();
  system.node_mass.insert(system.node_mass.end(), nodes,
                          bodies.density_kg_per_m3 * shape.volume / static_cast<double>(nodes));
}

/// The sum over the bodies; nothing unless all of them state their size.
std::optional<SceneCounts> stated(const SceneSpec& spec) {
  SceneCounts counts;
  for (const BodySpec& body : bodies_of(spec).list) {
    const std::optional<MeshSize> size = stated_size(body, own_shape(body.shape, spec.file.parent_path()));
    if (!size) return std::nullopt;
    counts.nodes += size->nodes;
    counts.springs_unique += size->springs;
  }
  return counts;
}

/// Throws SceneError if a body starts below the floor.
System build_bodies(const SceneSpec& spec, const MeshedShapes& shapes) {
  const BodiesSpec& bodies = bodies_of(spec);
  System system;
  set_laws(system, spec);
  system.materials = {bodies.springs};
  TetrahedralMesh mesh;
  for (std::size_t i = 0; i < bodies.list.size(); ++i) {
    const std::size_t first = system.nodes(), first_spring = system.springs.size();
    add_body(system, mesh.tetrahedra, shapes.of_body(i), bodies, bodies.list[i]);
    double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
    for (std::size_t node = first; node < system.nodes(); ++node) {
      lowest = std::min(lowest, system.start.position[node].y);
      highest = std::max(highest, system.start.position[node].y);
    }
    // The message has the height because it reveals a wrong unit_m.
    if (!(lowest > spec.floor.height))
      refuse(spec.file, pointer_to(i) + "/centre_m/1",
             "is " + shown_number(bodies.list[i].centre_m.y) + ", so the lowest node of the body, which is " +
                 shown(highest - lowest) + " m high, would start at " + shown(lowest) +
                 ", not above the floor at " + shown_number(spec.floor.height) + ": raise it");
    for (std::size_t s = first_spring; s < system.springs.size(); ++s) {
      const auto in_single = [&](std::uint32_t node) {
        return vec3_cast<float>(system.start.position[node]);
      };
      if (in_single(system.springs[s].first) == in_single(system.springs[s].second))
        refuse(spec.file, pointer_to(i) + "/centre_m",
               "is so far away that two nodes " + shown(system.springs[s].rest_length) +
                   " m apart start at the same place in single precision: move the body towards the origin");
    }
  }
  system.topology = std::move(mesh);
  return system;
}

void visit_fields(FieldVisitor& fields, SceneSpec& spec) {
  BodiesSpec& bodies = spec.content.emplace<BodiesSpec>();
  fields.number({"density_kg_per_m3", "Mass per volume, kg/m^3; the nodes of a body share its mass evenly."},
                bodies.density_kg_per_m3, from(1e-3, 1e6));
  fields.object(
      {"springs", "Stiffness and damping of the springs."}, Presence::required,
      [&](FieldVisitor& springs) { visit_material(springs, bodies.springs, above(0, largest_stiffness)); });
  fields.list({"list", "The bodies."}, Presence::required, most_bodies, "One body and its start.",
              [&](FieldVisitor& body) { visit_body(body, bodies.list.emplace_back()); });
}

/// Every rotation needs an axis.
void check(const SceneSpec& spec) {
  const BodiesSpec& bodies = bodies_of(spec);
  for (std::size_t i = 0; i < bodies.list.size(); ++i)
    if (!(longest_part(bodies.list[i].turn_axis) > 0))
      refuse(spec.file, pointer_to(i) + "/turn/axis", "has no direction: give another vector than zero");
}

/// Whether the scene file names other files, also another scene's.
bool names_files(const SceneSpec& spec) {
  return std::ranges::any_of(bodies_of(spec).list, [](const BodySpec& body) {
    if (const auto* other = std::get_if<ShapeOfScene>(&body.shape)) return is_path_of_scene(other->name);
    return std::holds_alternative<SurfaceFile>(body.shape) || std::holds_alternative<MeshFiles>(body.shape);
  });
}

/// Meshes every shape once.
///
/// The scene has its bodies one after the other, each in its mesh's node order; its springs are the edges of
/// its tetrahedra at their length in the mesh. A body starts rotated, in rigid flight and spin, and grows at
/// its swell rate. Deterministic. Throws SceneError if a body has no mesh or if the memory does not suffice
/// for the meshes, and MissingProgram; building throws SceneError if a body starts below the floor.
SceneParts read(const SceneSpec& spec) {
  const auto shapes = std::make_shared<const MeshedShapes>(spec);
  return {shapes->counts(),
          [shapes](const SceneSpec& of) {
            return BuiltScene{build_bodies(of, *shapes), shapes->note(of)};
          },
          shapes->files(), names_files(spec) ? std::optional(shapes->hash()) : std::nullopt};
}

}  // namespace

SceneCounts least_counts(const BodyShape& shape, const std::filesystem::path& folder) {
  return least_counts(own_shape(shape, folder));
}

const SceneKind BodiesSpec::kind{
    .name = "bodies",
    .description =
        "Solid bodies cut into tetrahedra, whose edges are the springs. They fall side by side; "
        "only the floor stops them.",
    .visit_fields = visit_fields,
    .check = check,
    // The published counts seem to be the length of the array of packed springs, three values per spring: all
    // nine are divisible by three, and the thirds fit tetrahedral meshes.
    .published_per_spring = 3,
    .stated = stated,
    .read = read,
};

}  // namespace mssim
