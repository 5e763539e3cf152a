#include "output/exports/ply_export.h"

#include <array>
#include <bit>

#include "text/text.h"

namespace mssim {
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
