#include "output/exports/export_mesh.h"

#include <numeric>
#include <utility>

#include "model/node_surface.h"
#include "output/traces/node_strain.h"

namespace mssim {

ExportMesh surface_mesh(const TraceContent& content) {
  NodeSurface surface = surface_of(content.topology, content.nodes);
  ExportMesh mesh{{surface.node.begin(), surface.node.end()},
                  {surface.part.begin(), surface.part.end()},
                  std::move(surface.parts),
                  std::move(surface.triangles),
                  {},
                  content.body.points,
                  content.in_double};
  const auto first = static_cast<std::uint32_t>(mesh.node.size());
  for (const auto& [a, b, c] : content.body.triangles)
    mesh.triangles.push_back({first + a, first + b, first + c});
  mesh.node.resize(first + mesh.fixed.size(), -1);
  mesh.part.resize(mesh.node.size(), -1);
  return mesh;
}

ExportMesh solid_mesh(const TraceContent& content) {
  ExportMesh mesh = surface_mesh(content);
  const auto* bodies = std::get_if<TetrahedralMesh>(&content.topology);
  if (!bodies) return mesh;
  mesh.triangles.clear();
  mesh.tetrahedra = bodies->tetrahedra;
  mesh.node.resize(content.nodes);
  std::iota(mesh.node.begin(), mesh.node.end(), 0);
  const std::vector<std::uint32_t> body = bodies_of(bodies->tetrahedra, content.nodes);
  mesh.part.assign(body.begin(), body.end());
  return mesh;
}

ExportFrame frame_of(const TraceReader& trace, const ExportMesh& mesh, std::size_t frame) {
  const std::vector<Vec3d> positions = trace.positions(frame), velocities = trace.velocities(frame);
  const std::vector<double> strain = node_strain(trace.content(), positions);
  ExportFrame shown{trace.content().time_s.at(frame), {}, {}, {}};
  for (const std::int32_t node : mesh.node) {
    if (node < 0) break;
    const auto i = static_cast<std::size_t>(node);
    shown.position.push_back(positions[i]);
    shown.velocity.push_back(velocities[i]);
    shown.strain.push_back(strain[i]);
  }
  shown.position.insert(shown.position.end(), mesh.fixed.begin(), mesh.fixed.end());
  shown.velocity.resize(mesh.node.size());
  shown.strain.resize(mesh.node.size());
  return shown;
}

}  // namespace mssim
