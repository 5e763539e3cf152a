#include "output/exports/exports.h"

#include <array>
#include <bit>
#include <charconv>
#include <numeric>
#include <utility>

#include "model/node_surface.h"
#include "output/traces/trace_content.h"
#include "text/text.h"

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

namespace {

/// A blank and the shortest text that reads back as the same number.
void append_number(std::string& text, double value, bool in_double) {
  std::array<char, 32> digits{};
  char* const begin = digits.data();
  char* const end = begin + digits.size();
  text += ' ';
  text.append(begin, in_double ? std::to_chars(begin, end, value).ptr
                               : std::to_chars(begin, end, static_cast<float>(value)).ptr);
}

}  // namespace

std::string obj_of(const ExportMesh& mesh, const ExportFrame& frame) {
  std::string text = "# mssim, time " + decimal(frame.time_s) + " s, lengths in m\n";
  for (const Vec3d& point : frame.position) {
    text += 'v';
    for (const double number : {point.x, point.y, point.z}) append_number(text, number, mesh.in_double);
    text += '\n';
  }
  const std::array<std::uint32_t, 3>* before = nullptr;
  for (const auto& triangle : mesh.triangles) {
    const std::int32_t part = mesh.part[triangle[0]];
    if (!before || part != mesh.part[(*before)[0]])
      text += "o " + (part < 0 ? "person" : printable(mesh.parts[static_cast<std::size_t>(part)])) + '\n';
    before = &triangle;
    text += 'f';
    for (const std::uint32_t point : triangle) text += ' ' + std::to_string(point + std::uint64_t{1});
    text += '\n';
  }
  return text;
}

namespace {

template <class Number>
void append_bytes(std::string& bytes, Number number) {
  static_assert(std::endian::native == std::endian::little);
  const auto raw = std::bit_cast<std::array<char, sizeof(Number)>>(number);
  bytes.append(raw.data(), raw.size());
}

std::string header(const ExportMesh& mesh, double time_s) {
  std::string text =
      "ply\nformat binary_little_endian 1.0\ncomment mssim, time " + decimal(time_s) + " s, SI units\n";
  for (std::size_t part = 0; part < mesh.parts.size(); ++part)
    text += "comment part " + std::to_string(part) + ": " + printable(mesh.parts[part]) + '\n';
  text += "element vertex " + std::to_string(mesh.node.size()) + '\n';
  const std::string type = mesh.in_double ? "double" : "float";
  for (const char* name : {"x", "y", "z", "vx", "vy", "vz", "strain"})
    text += "property " + type + ' ' + name + '\n';
  return text + "property int node\nproperty int part\nelement face " +
         std::to_string(mesh.triangles.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
}

}  // namespace

std::string ply_of(const ExportMesh& mesh, const ExportFrame& frame) {
  std::string bytes = header(mesh, frame.time_s);
  for (std::size_t i = 0; i < mesh.node.size(); ++i) {
    const Vec3d &x = frame.position[i], &v = frame.velocity[i];
    for (const double number : {x.x, x.y, x.z, v.x, v.y, v.z, frame.strain[i]})
      if (mesh.in_double)
        append_bytes(bytes, number);
      else
        append_bytes(bytes, static_cast<float>(number));
    append_bytes(bytes, mesh.node[i]);
    append_bytes(bytes, mesh.part[i]);
  }
  for (const auto& triangle : mesh.triangles) {
    bytes += static_cast<char>(triangle.size());
    for (const std::uint32_t point : triangle) append_bytes(bytes, point);
  }
  return bytes;
}

}  // namespace mssim
