#include "mesh/surface_mesh.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>

#include "geometry/geometry.h"
#include "mesh/surface_file.h"
#include "mesh/tetgen.h"
#include "mesh/tetrahedralise.h"
#include "text/input_error.h"

namespace mssim {
namespace {

/// Nodes are added, on the surface too, until no tetrahedron's circumscribed sphere has a radius of more
/// than 1.414 times its shortest edge. (The surface's triangles may be few and long; kept as they are, they
/// would stay the springs of the body.)
const std::string fill_well = "-pq1.414";

/// The limit in TetGen's form, which has no exponents.
std::string volume_switch(double largest_volume_m3) {
  if (largest_volume_m3 == 0) return "";
  std::array<char, 512> text;
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), largest_volume_m3, std::chars_format::fixed).ptr;
  return "a" + std::string(text.data(), end);
}

}  // namespace

TetMesh surface_mesh(const SurfaceShape& body) {
  const std::string name = body.file.string();
  if (!(body.unit_m > 0) || !std::isfinite(body.unit_m))
    throw InputError(name + ": a unit of the file is " + decimal(body.unit_m) + " m; give a positive number");
  if (!(body.largest_volume_m3 >= 0) || !std::isfinite(body.largest_volume_m3))
    throw InputError(name + ": the largest volume of a tetrahedron is " + decimal(body.largest_volume_m3) +
                     " m^3; give a positive number, or 0 for no limit");

  Surface surface = read_surface(body.file);
  for (Vec3d& point : surface.points) point = body.unit_m * point;
  validate_surface(surface, name);
  // A limit far below the body's volume would fill the memory.
  constexpr double most_tetrahedra = 1e7;
  constexpr double tetrahedra_a_node = 7;  // of a fine mesh, a little fewer
  if (body.largest_volume_m3 > 0 && volume_of(surface) / body.largest_volume_m3 > most_tetrahedra)
    throw InputError(name + ": tetrahedra of at most " + decimal(body.largest_volume_m3) +
                     " m^3 in a body of " + shown(volume_of(surface)) +
                     " m^3 would be more than ten million; give a larger volume");
  const double tetrahedra =
      body.largest_volume_m3 > 0 ? volume_of(surface) / body.largest_volume_m3 : 0;  // at least
  const auto nodes = std::max(std::uint64_t{surface.points.size()},
                              static_cast<std::uint64_t>(tetrahedra / tetrahedra_a_node));
  try {
    require_meshable(nodes);
    return tetrahedralise(surface, {}, fill_well + volume_switch(body.largest_volume_m3),
                          nodes - surface.points.size());
  } catch (const InputError& error) {
    throw InputError(name + ": " + error.what());
  }
}

}  // namespace mssim
