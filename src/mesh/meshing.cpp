#include "mesh/meshing.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <numeric>
#include <tuple>
#include <utility>

#include "geometry/geometry.h"
#include "geometry/triangle_tree.h"
#include "mesh/surface_file.h"
#include "mesh/tetgen.h"
#include "mesh/text_lines.h"
#include "platform/files.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

double six_volumes_of(const TetMesh& mesh, const Tetrahedron& nodes) {
  return six_volumes(mesh.nodes[nodes[0]], mesh.nodes[nodes[1]], mesh.nodes[nodes[2]], mesh.nodes[nodes[3]]);
}

/// Six times the volume below which a tetrahedron of this longest edge is flat: rounding decides its sign.
double flat_six_volumes(const TetMesh& mesh, const Tetrahedron& nodes) {
  double longest = 0;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = i + 1; j < 4; ++j)
      longest = std::max(longest, length(mesh.nodes[nodes[i]] - mesh.nodes[nodes[j]]));
  return 1e-10 * longest * longest * longest;
}

std::optional<MeshDefect> unused_node(const TetMesh& mesh) {
  std::vector<bool> used(mesh.nodes.size());
  for (const Tetrahedron& nodes : mesh.tetrahedra)
    for (const std::uint32_t node : nodes) used[node] = true;
  const auto unused = std::find(used.begin(), used.end(), false);
  if (unused == used.end()) return std::nullopt;
  return MeshDefect{MeshDefect::node, static_cast<std::size_t>(unused - used.begin()),
                    "no tetrahedron has this node; remove it"};
}

std::optional<MeshDefect> node_twice(const TetMesh& mesh) {
  std::vector<std::size_t> order(mesh.nodes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto key = [&](std::size_t n) {
    return std::tuple(mesh.nodes[n].x, mesh.nodes[n].y, mesh.nodes[n].z, n);
  };
  std::ranges::sort(order, {}, key);
  const auto same = std::ranges::adjacent_find(order, {}, [&](std::size_t n) { return mesh.nodes[n]; });
  if (same == order.end()) return std::nullopt;
  return MeshDefect{MeshDefect::node, *(same + 1),
                    fmt::format("another node is at {} too; merge the two", place(mesh.nodes[*same]))};
}

std::optional<MeshDefect> bad_volume(const TetMesh& mesh) {
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const double volume = six_volumes_of(mesh, mesh.tetrahedra[t]) / 6;
    const double flat = flat_six_volumes(mesh, mesh.tetrahedra[t]) / 6;
    if (volume > flat) continue;
    const bool is_flat = volume >= -flat;
    return MeshDefect{
        MeshDefect::tetrahedron, t,
        fmt::format("the tetrahedron's volume is {} m^3{}", shown(volume),
                    is_flat ? ": it is flat; move its nodes apart or remove it"
                            : " while others' are positive; list its nodes in the same sense as theirs")};
  }
  return std::nullopt;
}

std::optional<MeshDefect> crowded_face(const TetMesh& mesh) {
  const auto faces = faces_of(mesh);
  for (std::size_t f = 0; f + 2 < faces.size(); ++f) {
    if (faces[f] != faces[f + 2]) continue;
    const auto has_face = [&](Tetrahedron nodes) {
      std::sort(nodes.begin(), nodes.end());
      return std::includes(nodes.begin(), nodes.end(), faces[f].begin(), faces[f].end());
    };
    const auto last = std::find_if(mesh.tetrahedra.rbegin(), mesh.tetrahedra.rend(), has_face);
    return MeshDefect{
        MeshDefect::tetrahedron, static_cast<std::size_t>(mesh.tetrahedra.rend() - last) - 1,
        "the tetrahedron shares a face with two others or more; tetrahedra of a body do not overlap, so "
        "remove the duplicates"};
  }
  return std::nullopt;
}

namespace fs = std::filesystem;

constexpr std::string_view extension = ".mesh";

/// "mssim mesh 1 BYTES HASH": bytes of the .node text, hash of both texts.
std::string header_of(const std::string& nodes, const std::string& tetrahedra) {
  return fmt::format("mssim mesh 1 {} {}\n", nodes.size(), to_hex(fnv1a_64(nodes + tetrahedra)));
}

/// The mesh in the file, or nothing if the file is missing, damaged or foreign.
std::optional<TetMesh> read_entry(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return std::nullopt;
  try {
    const std::string text = read_text(file);
    const std::size_t header = text.find('\n') + 1;
    constexpr std::string_view begin = "mssim mesh 1 ";
    if (header == 0 || !text.starts_with(begin)) return std::nullopt;
    const std::size_t node_bytes = std::strtoull(text.c_str() + begin.size(), nullptr, 10);
    if (node_bytes > text.size() - header) return std::nullopt;
    const std::string nodes = text.substr(header, node_bytes);
    const std::string tetrahedra = text.substr(header + node_bytes);
    if (!text.starts_with(header_of(nodes, tetrahedra))) return std::nullopt;
    return parse_tetgen_files({file.string(), nodes}, {file.string(), tetrahedra});
  } catch (const InputError&) {
    return std::nullopt;
  }
}

/// Cache of meshes, one file each, in mssim/meshes in the user's cache folder ($XDG_CACHE_HOME or ~/.cache).
/// A file's name is INPUT-PROGRAM: hashes of TetGen's input and of the TetGen that made the mesh. The cache
/// only saves time: an entry that is missing, damaged or cannot be written is no error, and several processes
/// may use it at once.
class MeshCache {
 public:
  /// The mesh that this TetGen made from this input.
  std::optional<TetMesh> find(std::uint64_t input, std::uint64_t program) const {
    if (folder_.empty()) return std::nullopt;
    return read_entry(entry(input, program));
  }

  /// The newest mesh that any TetGen made from this input: for machines without TetGen.
  std::optional<TetMesh> find_of_any_program(std::uint64_t input) const {
    if (folder_.empty()) return std::nullopt;
    std::optional<TetMesh> newest;
    fs::file_time_type newest_time = fs::file_time_type::min();
    for (const fs::path& file : entries_of(folder_)) {
      const std::string name = file.filename().string();
      if (!name.starts_with(to_hex(input) + '-') || !name.ends_with(extension)) continue;
      std::error_code no_time;
      const fs::file_time_type time = fs::last_write_time(file, no_time);
      if (no_time || (newest && time <= newest_time)) continue;
      if (auto mesh = read_entry(file)) {
        newest = std::move(mesh);
        newest_time = time;
      }
    }
    return newest;
  }

  /// Keeps a mesh; the file appears as a whole or not at all.
  void store(std::uint64_t input, std::uint64_t program, const TetMesh& mesh) const {
    if (folder_.empty()) return;
    std::error_code ignored;
    fs::create_directories(folder_, ignored);
    const std::string nodes = node_text(mesh.nodes), tetrahedra = ele_text(mesh.tetrahedra);
    try {
      write_file_atomically(entry(input, program), header_of(nodes, tetrahedra) + nodes + tetrahedra);
    } catch (const WriteError&) {
      // The mesh is made again next time, or another process is storing it.
    }
  }

 private:
  fs::path entry(std::uint64_t input, std::uint64_t program) const {
    return folder_ / fmt::format("{}-{}{}", to_hex(input), to_hex(program), extension);
  }

  fs::path folder_ = cache_folder("meshes");  ///< empty if the user has neither variable nor home
};

/// TetGen adds nodes, on the surface too, until no tetrahedron's circumscribed sphere has a radius of more
/// than 1.414 times its shortest edge. (Long triangles of the surface, if kept, would become springs of the
/// body.)
const std::string fill_well = "-pq1.414";

/// The limit as TetGen's switch, which takes no exponents.
std::string volume_switch(double largest_volume_m3) {
  if (largest_volume_m3 == 0) return "";
  std::array<char, 512> text;
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), largest_volume_m3, std::chars_format::fixed).ptr;
  return "a" + std::string(text.data(), end);
}

/// Thickness of a body at a point of its surface.
struct Thickness {
  double size = 0;  ///< m, the diameter of the largest ball inside that touches the surface there
  Vec3d at;
};

/// Samples the surface uniformly by area and returns the places where the body is thinner than `limit`, m,
/// the thinnest first.
std::vector<Thickness> thin_places(Surface surface, const std::vector<double>& area_up_to,
                                   std::size_t samples, double limit) {
  // Far from the origin, rounding would make any body thin.
  const Vec3d origin = surface.points.front();
  for (Vec3d& point : surface.points) point -= origin;
  const TriangleTree tree(surface);
  std::vector<Thickness> thin;
  for (std::size_t i = 0; i < samples; ++i) {
    const double share = (static_cast<double>(i) + 0.5) / static_cast<double>(samples);
    const auto found = std::ranges::upper_bound(area_up_to, share * area_up_to.back());
    const auto t = std::min(static_cast<std::size_t>(found - area_up_to.begin()), area_up_to.size() - 1);
    const auto& [a, b, c] = surface.triangles[t];
    const Vec3d &corner = surface.points[a], ab = surface.points[b] - corner, ac = surface.points[c] - corner;
    // Roberts' sequence in the plane, folded into the triangle.
    constexpr double step_b = 0.7548776662466927, step_c = 0.5698402909980532;
    const double number = static_cast<double>(i + 1);
    double of_b = number * step_b - std::floor(number * step_b),
           of_c = number * step_c - std::floor(number * step_c);
    if (of_b + of_c > 1) of_b = 1 - of_b, of_c = 1 - of_c;
    const Vec3d at = corner + of_b * ab + of_c * ac, normal = cross(ab, ac),
                inwards = -1 / length(normal) * normal;
    const auto has_room = [&](double size) {
      constexpr double rounding = 1e-6;
      const double least = size / 2 * (1 - rounding);
      return tree.distance(at + size / 2 * inwards, least) >= least;
    };
    if (has_room(limit)) continue;
    thin.push_back({bisected({0, limit}, 20, has_room).fails, origin + at});
  }
  std::ranges::sort(thin, {}, &Thickness::size);
  return thin;
}

/// Throws InputError if at least a hundredth of the surface is so thin that the mesh needs too many nodes:
/// tetrahedra as wide as they are high take half a node for each square of the surface with the body's
/// thickness as its side. For sheets of 1 m x 1 m x 0.1 to 0.005 m, TetGen makes 0.9 to 1.1 of that.
void require_thick(const Surface& surface) {
  std::vector<double> area_up_to;
  double area = 0;
  for (const auto& [a, b, c] : surface.triangles) {
    area += length(cross(surface.points[b] - surface.points[a], surface.points[c] - surface.points[a])) / 2;
    area_up_to.push_back(area);
  }
  constexpr std::size_t samples = 1000, fewest = samples / 100;
  constexpr double nodes_a_square = 0.5;
  const double enough = std::sqrt(nodes_a_square * area / static_cast<double>(most_meshable_points));
  const std::vector<Thickness> thin = thin_places(surface, area_up_to, samples, enough);
  double most_nodes = 0;
  Thickness worst;
  for (std::size_t count = fewest; count <= thin.size(); ++count) {
    const Thickness& here = thin[count - 1];
    const double share = static_cast<double>(count) / samples;
    const double nodes = nodes_a_square * share * area / (here.size * here.size);
    if (nodes > most_nodes) most_nodes = nodes, worst = here;
  }
  constexpr double countable = 1e18;
  try {
    require_meshable(static_cast<std::uint64_t>(std::min(most_nodes, countable)),
                     "by a body that is thicker there");
  } catch (const InputError& error) {
    throw InputError("it is {} m thick at {}: {}", two_digits(worst.size), place(worst.at), error.what());
  }
}

}  // namespace

std::vector<std::array<std::uint32_t, 2>> edges_of(const TetMesh& mesh) {
  std::vector<std::array<std::uint32_t, 2>> edges;
  edges.reserve(6 * mesh.tetrahedra.size());
  for (const Tetrahedron& nodes : mesh.tetrahedra)
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = i + 1; j < 4; ++j)
        edges.push_back({std::min(nodes[i], nodes[j]), std::max(nodes[i], nodes[j])});
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

std::vector<std::array<std::uint32_t, 3>> faces_of(const TetMesh& mesh) {
  std::vector<std::array<std::uint32_t, 3>> faces;
  faces.reserve(4 * mesh.tetrahedra.size());
  for (const auto& [a, b, c, d] : mesh.tetrahedra)
    for (std::array<std::uint32_t, 3> face : {std::array{b, c, d}, {a, c, d}, {a, b, d}, {a, b, c}}) {
      std::sort(face.begin(), face.end());
      faces.push_back(face);
    }
  std::sort(faces.begin(), faces.end());
  return faces;
}

double volume_of(const TetMesh& mesh) {
  double six_times = 0;
  for (const auto& [a, b, c, d] : mesh.tetrahedra)
    six_times += six_volumes(mesh.nodes[a], mesh.nodes[b], mesh.nodes[c], mesh.nodes[d]);
  return six_times / 6;
}

double smallest_dihedral_angle(const TetMesh& mesh) {
  double largest_cosine = -1;
  for (const Tetrahedron& nodes : mesh.tetrahedra) {
    const Vec3d& a = mesh.nodes[nodes[0]];
    const Vec3d ab = mesh.nodes[nodes[1]] - a;
    const Vec3d ac = mesh.nodes[nodes[2]] - a;
    const Vec3d ad = mesh.nodes[nodes[3]] - a;
    // Outward normals of the four faces; the angle between two faces is 180 degrees minus that of their
    // normals.
    const std::array normals{cross(ac - ab, ad - ab), cross(ad, ac), cross(ab, ad), cross(ac, ab)};
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = i + 1; j < 4; ++j)
        largest_cosine = std::max(largest_cosine,
                                  -dot(normals[i], normals[j]) / (length(normals[i]) * length(normals[j])));
  }
  return std::acos(std::clamp(largest_cosine, -1.0, 1.0)) * 180 / std::numbers::pi;
}

std::optional<MeshDefect> find_defect(const TetMesh& mesh) {
  for (const auto find : {unused_node, node_twice, bad_volume, crowded_face})
    if (auto defect = find(mesh)) return defect;
  return std::nullopt;
}

void turn_if_mirrored(TetMesh& mesh) {
  const auto is_negative = [&](const Tetrahedron& nodes) {
    return six_volumes_of(mesh, nodes) < -flat_six_volumes(mesh, nodes);
  };
  if (!std::all_of(mesh.tetrahedra.begin(), mesh.tetrahedra.end(), is_negative)) return;
  for (Tetrahedron& nodes : mesh.tetrahedra) std::swap(nodes[2], nodes[3]);
}

TetMesh tetrahedralise(const Surface& surface, const std::vector<Vec3d>& interior,
                       const std::string& switches, std::uint64_t added_points) {
  const std::uint64_t input = fnv1a_64(switches + '\n' + smesh_text(surface) + node_text(interior));
  const MeshCache cache;
  const auto program = find_tetgen();
  if (!program) {
    if (auto mesh = cache.find_of_any_program(input)) return *mesh;
    throw MissingProgram(
        "the program tetgen, which makes the meshes of bodies, is not in PATH; install Debian's package "
        "tetgen");
  }
  if (auto mesh = cache.find(input, program->fnv1a_64)) return *mesh;
  require_meshing_memory(surface.points.size() + interior.size() + added_points);
  TetMesh mesh = run_tetgen(*program, surface, interior, switches);
  cache.store(input, program->fnv1a_64, mesh);
  return mesh;
}

TetMesh shape_mesh(const GeneratedShape& shape) {
  require_meshable(point_count(shape));
  ShapePoints points = points_of(shape);
  TetMesh mesh = tetrahedralise(points.surface, points.interior, keep_surface);
  std::vector<Vec3d> wanted = std::move(points.surface.points);
  wanted.insert(wanted.end(), points.interior.begin(), points.interior.end());
  const auto lacks = std::ranges::mismatch(wanted, mesh.nodes).in1;
  if (lacks != wanted.end())
    throw InputError("TetGen's mesh lacks the point at {}; give fewer points inside, or a larger margin",
                     place(*lacks));
  return mesh;
}

TetMesh surface_mesh(const SurfaceFile& body) {
  const std::string& name = body.file;
  auto [surface, note] = read_surface(body.file);
  for (Vec3d& point : surface.points) point = body.unit_m * point;
  validate_surface(surface, name);
  const double volume = volume_of(surface);
  const double tetrahedra =
      body.largest_tetrahedron_m3 > 0 ? volume / body.largest_tetrahedron_m3 : 0;  // lower bound
  constexpr double tetrahedra_a_node = 7;  // slightly less than in a fine mesh
  // A limit far below the body's volume would fill the memory.
  if (tetrahedra > 1e7)
    throw InputError(
        "{}: tetrahedra of at most {} m^3 in a body of {} m^3 would be more than ten million; give a larger "
        "volume, or check unit_m",
        name, decimal(body.largest_tetrahedron_m3), shown(volume));
  const auto nodes = std::max(std::uint64_t{surface.points.size()},
                              static_cast<std::uint64_t>(tetrahedra / tetrahedra_a_node));
  try {
    require_meshable(nodes);
    require_thick(surface);
    TetMesh mesh = tetrahedralise(surface, {}, fill_well + volume_switch(body.largest_tetrahedron_m3),
                                  nodes - surface.points.size());
    mesh.note = std::move(note);
    return mesh;
  } catch (const InputError& error) {
    throw InputError(name + ": " + error.what());
  }
}

}  // namespace mssim
