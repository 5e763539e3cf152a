#include "scene/bodies.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "geometry/geometry.h"
#include "platform/machine.h"
#include "scene/body_shapes.h"
#include "scene/fields/fields.h"
#include "scene/spec/scene_spec.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

constexpr std::size_t most_bodies = 10'000;

/// How short and long a spring of a body may be, m. Within, lengths, masses and stiffnesses over masses are
/// ordinary numbers in single precision.
constexpr double shortest_spring = 1e-7, longest_spring = 1e6;

const BodiesSpec& bodies_of(const SceneSpec& spec) { return std::get<BodiesSpec>(spec.content); }

void visit_body(FieldVisitor& fields, BodySpec& body) {
  visit_shape_fields(fields, body);
  fields.vector({"centre_m", "Where the centre of mass starts, [x, y, z], m."}, Presence::required,
                body.centre_m, from(-1e6, 1e6));
  fields.object({"turn", "How the shape is turned about its centre at the start."}, Presence::optional,
                [&](FieldVisitor& turn) {
                  turn.vector({"axis", "Direction of the axis, of any length but zero."}, Presence::required,
                              body.turn_axis, from(-1, 1));
                  turn.number({"angle_deg", "Angle, degrees."}, body.turn_deg, from(-360, 360));
                });
  fields.vector({"velocity_m_per_s", "Velocity of the centre at the start, m/s."}, Presence::required,
                body.velocity_m_per_s, from(-1000, 1000));
  fields.vector({"spin_rad_per_s", "Angular velocity about the centre at the start, rad/s."},
                Presence::required, body.spin_rad_per_s, from(-1000, 1000));
  fields.number(
      {"swell_per_s",
       "Rate at which the body grows at first, 1/s, so that every spring works from the first step on."},
      body.swell_per_s, from(-100, 100));
}

std::string pointer_to(std::size_t body) { return "/bodies/list/" + std::to_string(body); }

/// A shape of bodies: a mesh and what follows from it.
struct MeshedShape {
  std::size_t first_body;  ///< that has it
  OwnShape own;
  TetMesh mesh = {};  ///< its centre is the origin
  std::vector<std::array<std::uint32_t, 2>> edges = {};
  double volume = 0;  ///< m^3
};

/// Throws SceneError where it is that of another scene, which cannot be used.
OwnShape shape_of(const SceneSpec& spec, std::size_t body) {
  try {
    return own_shape(bodies_of(spec).list[body].shape, spec.file.parent_path());
  } catch (const SceneError& error) {
    refuse(spec.file, pointer_to(body), "has no mesh: " + printable(error.what(), 1500));
  }
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
  try {
    shape.mesh = mesh_of(shape.own);
  } catch (const InputError& error) {
    refuse(spec.file, pointer_to(shape.first_body), "has no mesh: " + printable(error.what(), 1500));
  }
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
  /// Throws SceneError, where the memory does not do for what will be meshed before it is, and
  /// MissingProgram.
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

  /// Of all bodies together.
  SceneCounts counts() const {
    SceneCounts counts;
    for (const std::size_t shape : of_body_) {
      counts.nodes += shapes_[shape].mesh.nodes.size();
      counts.springs_unique += shapes_[shape].edges.size();
    }
    return counts;
  }

  /// What is to be known of how they were made, in sentences; or empty.
  std::string note() const {
    std::string all;
    for (const MeshedShape& shape : shapes_) append_sentence(all, shape.mesh.note);
    return all;
  }

 private:
  /// Meshing takes minutes where there are millions of nodes: what cannot be held afterwards is refused
  /// before.
  void require_memory_for_meshes(const SceneSpec& spec) const {
    SceneCounts least;
    for (const std::size_t shape : of_body_) {
      const SceneCounts body = least_counts(shapes_[shape].own);
      least.nodes += body.nodes;
      least.springs_unique += body.springs_unique;
    }
    if (const auto shortage = memory_shortage(memory_needed(least.nodes, least.springs_unique)))
      refuse(spec.file, "/bodies",
             "has at least " + std::to_string(least.nodes) + " nodes and " +
                 std::to_string(least.springs_unique) + " springs and " + *shortage +
                 ": give fewer bodies, or bodies of fewer cells or points");
  }

  std::vector<MeshedShape> shapes_;
  std::vector<std::size_t> of_body_;  ///< the number of its shape
};

/// Rodrigues' rotation by `angle` (radians) about the unit vector `axis`.
Vec3d turned(const Vec3d& r, const Vec3d& axis, double angle) {
  const double c = std::cos(angle);
  return c * r + std::sin(angle) * cross(axis, r) + (1 - c) * dot(axis, r) * axis;
}

void add_body(System& system, std::vector<Tetrahedron>& tetrahedra, const MeshedShape& shape,
              const BodiesSpec& bodies, const BodySpec& body) {
  const auto first = static_cast<std::uint32_t>(system.nodes());
  const Vec3d axis = 1 / length(body.turn_axis) * body.turn_axis;
  for (const Vec3d& node : shape.mesh.nodes) {
    const Vec3d r = turned(node, axis, body.turn_deg * std::numbers::pi / 180);
    system.start.position.push_back(body.centre_m + r);
    system.start.velocity.push_back(body.velocity_m_per_s + cross(body.spin_rad_per_s, r) +
                                    body.swell_per_s * r);
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

/// The sum over the bodies; none unless all of them state their size.
std::optional<SceneCounts> stated_counts_of(const SceneSpec& spec,
                                            const std::function<OwnShape(std::size_t body)>& shape_of) {
  SceneCounts counts;
  const std::vector<BodySpec>& list = bodies_of(spec).list;
  for (std::size_t body = 0; body < list.size(); ++body) {
    const std::optional<MeshSize> size = stated_size(list[body], shape_of(body));
    if (!size) return std::nullopt;
    counts.nodes += size->nodes;
    counts.springs_unique += size->springs;
  }
  return counts;
}

/// Throws SceneError when a body starts below the floor and when the memory does not suffice.
System build_bodies(const SceneSpec& spec, const MeshedShapes& shapes) {
  const BodiesSpec& bodies = bodies_of(spec);
  require_memory(spec, "/bodies", shapes.counts());
  System system;
  system.materials = {bodies.springs};
  system.gravity = spec.gravity_m_per_s2;
  system.viscous_damping = spec.viscous_damping_per_s;
  system.floor = spec.floor;
  system.solver = spec.solver;
  TetrahedralMesh mesh;
  for (std::size_t i = 0; i < bodies.list.size(); ++i) {
    const std::size_t first = system.nodes(), first_spring = system.springs.size();
    add_body(system, mesh.tetrahedra, shapes.of_body(i), bodies, bodies.list[i]);
    double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
    for (std::size_t node = first; node < system.nodes(); ++node) {
      lowest = std::min(lowest, system.start.position[node].y);
      highest = std::max(highest, system.start.position[node].y);
    }
    // The height shows a mesh in another unit than its unit_m says.
    if (!(lowest > spec.floor.height))
      refuse(spec.file, pointer_to(i) + "/centre_m/1",
             "is " + shown_number(bodies.list[i].centre_m.y) +
                 ", so that the lowest node of the body, which is " + shown(highest - lowest) +
                 " m high, would start at " + shown(lowest) + ", not above the floor at " +
                 shown_number(spec.floor.height) + ": raise it");
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

}  // namespace

void visit_bodies_fields(FieldVisitor& fields, SceneSpec& spec) {
  BodiesSpec& bodies = spec.content.emplace<BodiesSpec>();
  fields.number(
      {"density_kg_per_m3", "Mass per volume, kg/m^3; the mass of a body is spread evenly over its nodes."},
      bodies.density_kg_per_m3, from(1e-3, 1e6));
  fields.object(
      {"springs", "How the springs answer stretching."}, Presence::required,
      [&](FieldVisitor& springs) { visit_material(springs, bodies.springs, above(0, largest_stiffness)); });
  fields.list({"list", "The bodies."}, Presence::required, most_bodies,
              {"One body, and how it starts.",
               [&](FieldVisitor& body) { visit_body(body, bodies.list.emplace_back()); }});
}

void check_bodies(const SceneSpec& spec) {
  const BodiesSpec& bodies = bodies_of(spec);
  for (std::size_t i = 0; i < bodies.list.size(); ++i)
    if (!(length(bodies.list[i].turn_axis) > 1e-6))
      refuse(spec.file, pointer_to(i) + "/turn/axis", "has no direction: give another vector than zero");
}

std::optional<SceneCounts> stated_bodies_counts(const SceneSpec& spec) {
  return stated_counts_of(spec, [&](std::size_t body) {
    return own_shape(bodies_of(spec).list[body].shape, spec.file.parent_path());
  });
}

SceneParts read_bodies(const SceneSpec& spec) {
  const auto shapes = std::make_shared<const MeshedShapes>(spec);
  return {shapes->counts(),
          stated_counts_of(spec, [&](std::size_t body) { return shapes->of_body(body).own; }),
          [shapes](const SceneSpec& of) {
            return BuiltScene{build_bodies(of, *shapes), shapes->note()};
          }};
}

}  // namespace mssim
