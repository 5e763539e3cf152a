#include "output/exports/exports.h"

#include <fmt/core.h>

#include <bit>
#include <charconv>
#include <numeric>
#include <string_view>
#include <utility>

#include "model/node_shape.h"
#include "text/text.h"

namespace mssim {
namespace {

/// Appends a blank and the shortest text that reads back as the same number.
void append_number(std::string& text, double value, bool in_double) {
  std::array<char, 32> digits{};
  char* const begin = digits.data();
  char* const end = begin + digits.size();
  text += ' ';
  text.append(begin, in_double ? std::to_chars(begin, end, value).ptr
                               : std::to_chars(begin, end, static_cast<float>(value)).ptr);
}

std::string header(const ExportMesh& mesh, double time_s) {
  std::string text = fmt::format("ply\nformat binary_little_endian 1.0\ncomment mssim, time {} s, SI units\n",
                                 decimal(time_s));
  for (std::size_t part = 0; part < mesh.parts.size(); ++part)
    text += fmt::format("comment part {}: {}\n", part, printable(mesh.parts[part]));
  text += fmt::format("element vertex {}\n", mesh.node.size());
  const std::string type = mesh.in_double ? "double" : "float";
  for (const char* name : {"x", "y", "z", "vx", "vy", "vz", "strain"})
    text += fmt::format("property {} {}\n", type, name);
  return text + "property int node\nproperty int part\nelement face " +
         std::to_string(mesh.triangles.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
}

/// Upper bound of what HDF5 adds to a file at a time.
constexpr std::size_t room_for_metadata = 65536;

void write_integers(hid_t file, const std::string& path, const std::vector<std::int64_t>& numbers,
                    std::size_t columns = 0) {
  std::vector<hsize_t> shape{numbers.size()};
  if (columns > 0) shape = {numbers.size() / columns, columns};
  write_array(file, path, H5T_STD_I64LE, H5T_NATIVE_INT64, shape, numbers.data());
}

/// Cells with `corners` corners each; `type` is VTK's number of their kind.
template <std::size_t corners>
void write_cells(hid_t file, const std::vector<std::array<std::uint32_t, corners>>& cells,
                 std::uint8_t type) {
  std::vector<std::int64_t> connectivity, offsets{0};
  for (const auto& cell : cells) {
    connectivity.insert(connectivity.end(), cell.begin(), cell.end());
    offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
  }
  const std::vector<std::uint8_t> types(cells.size(), type);
  write_integers(file, "/VTKHDF/NumberOfCells", {static_cast<std::int64_t>(cells.size())});
  write_integers(file, "/VTKHDF/NumberOfConnectivityIds", {static_cast<std::int64_t>(connectivity.size())});
  write_integers(file, "/VTKHDF/Connectivity", connectivity);
  write_integers(file, "/VTKHDF/Offsets", offsets);
  write_array(file, "/VTKHDF/Types", H5T_STD_U8LE, H5T_NATIVE_UINT8, std::array<hsize_t, 1>{types.size()},
              types.data());
}

}  // namespace

ExportMesh surface_mesh(const TraceContent& content) {
  NodeSurface surface = surface_of(content.shape, content.nodes);
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
  if (content.shape.tetrahedra.empty()) return mesh;
  mesh.triangles.clear();
  mesh.tetrahedra = content.shape.tetrahedra;
  mesh.node.resize(content.nodes);
  std::iota(mesh.node.begin(), mesh.node.end(), 0);
  const std::vector<std::uint32_t> body = bodies_of(mesh.tetrahedra, content.nodes);
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

std::string obj_of(const ExportMesh& mesh, const ExportFrame& frame) {
  std::string text = fmt::format("# mssim, time {} s, lengths in m\n", decimal(frame.time_s));
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
    for (const std::uint32_t point : triangle) text += fmt::format(" {}", point + std::uint64_t{1});
    text += '\n';
  }
  return text;
}

std::string ply_of(const ExportMesh& mesh, const ExportFrame& frame) {
  static_assert(std::endian::native == std::endian::little);
  std::string bytes = header(mesh, frame.time_s);
  for (std::size_t i = 0; i < mesh.node.size(); ++i) {
    const Vec3d &x = frame.position[i], &v = frame.velocity[i];
    for (const double number : {x.x, x.y, x.z, v.x, v.y, v.z, frame.strain[i]})
      if (mesh.in_double)
        bytes += bytes_of(number);
      else
        bytes += bytes_of(static_cast<float>(number));
    bytes += bytes_of(mesh.node[i]);
    bytes += bytes_of(mesh.part[i]);
  }
  for (const auto& triangle : mesh.triangles) {
    bytes += static_cast<char>(triangle.size());
    bytes += bytes_of(triangle);
  }
  return bytes;
}

VtkhdfExport::VtkhdfExport(std::filesystem::path file, const ExportMesh& mesh)
    : output_(std::move(file)), mesh_(mesh) {
  prepare_hdf5();
  guard([&] { create(); });
}

void VtkhdfExport::create() {
  constexpr std::uint8_t triangle = 5, tetrahedron = 10;
  constexpr std::array<std::int64_t, 2> version{2, 0};
  const std::size_t cell_bytes =
      sizeof(std::int64_t) * (3 * mesh_.triangles.size() + 6 * mesh_.tetrahedra.size());
  const std::string temporary = temporary_of(output_.name()).string();
  file_ = Hdf5File(H5Fcreate(temporary.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT),
                   "creating " + temporary);
  const hid_t file = file_.get();
  reserve_room(file, output_.name(), 2 * cell_bytes + room_for_metadata);
  const Hdf5Group root = create_group(file, "/VTKHDF");
  write_attribute(root.get(), "Version", version);
  write_attribute(root.get(), "Type", std::string_view("UnstructuredGrid"));
  if (mesh_.tetrahedra.empty())
    write_cells(file, mesh_.triangles, triangle);
  else
    write_cells(file, mesh_.tetrahedra, tetrahedron);
  const hsize_t points = mesh_.node.size();
  write_integers(file, "/VTKHDF/NumberOfPoints", {static_cast<std::int64_t>(points)});
  create_group(file, "/VTKHDF/PointData");
  write_integers(file, "/VTKHDF/PointData/node", {mesh_.node.begin(), mesh_.node.end()});
  write_integers(file, "/VTKHDF/PointData/part", {mesh_.part.begin(), mesh_.part.end()});
  const std::vector<std::string_view> parts(mesh_.parts.begin(), mesh_.parts.end());
  write_texts(file, "/parts", parts);
  const hid_t type = mesh_.in_double ? H5T_IEEE_F64LE : H5T_IEEE_F32LE;
  const std::array<hsize_t, 2> vectors{points, 3};
  points_ = create_series(file, "/VTKHDF/Points", type, vectors, Packing::deflated);
  velocity_ = create_series(file, "/VTKHDF/PointData/velocity", type, vectors, Packing::deflated);
  strain_ = create_series(file, "/VTKHDF/PointData/strain", type, std::array{points}, Packing::deflated);
}

void VtkhdfExport::append(const Hdf5Dataset& dataset, const std::string& name, const double* numbers) const {
  const hsize_t points = mesh_.node.size();
  write_rows(dataset, name, times_s_.size() * points, points, H5T_NATIVE_DOUBLE, numbers);
}

void VtkhdfExport::add(const ExportFrame& frame) {
  guard([&] {
    constexpr std::size_t numbers_per_point = 7;
    reserve_room(file_.get(), output_.name(),
                 numbers_per_point * mesh_.node.size() * sizeof(double) + room_for_metadata);
    static_assert(sizeof(Vec3d) == 3 * sizeof(double));
    append(points_, "positions", &frame.position.front().x);
    append(velocity_, "velocities", &frame.velocity.front().x);
    append(strain_, "strains", frame.strain.data());
    checked(H5Fflush(file_.get(), H5F_SCOPE_GLOBAL), "writing a frame");
  });
  times_s_.push_back(frame.time_s);
}

/// Writes the offsets of each frame in the datasets; data that is stored once has offset 0 in all frames.
void VtkhdfExport::write_steps() const {
  const hid_t file = file_.get();
  const std::size_t frames = times_s_.size();
  const std::vector<std::int64_t> zero(frames), one(frames, 1);
  std::vector<std::int64_t> first_point;
  for (std::size_t frame = 0; frame < frames; ++frame)
    first_point.push_back(static_cast<std::int64_t>(frame * mesh_.node.size()));
  const Hdf5Group steps = create_group(file, "/VTKHDF/Steps");
  write_attribute(steps.get(), "NSteps", static_cast<std::int64_t>(frames));
  write_numbers(file, "/VTKHDF/Steps/Values", times_s_);
  write_integers(file, "/VTKHDF/Steps/PartOffsets", zero);
  write_integers(file, "/VTKHDF/Steps/NumberOfParts", one);
  write_integers(file, "/VTKHDF/Steps/PointOffsets", first_point);
  write_integers(file, "/VTKHDF/Steps/CellOffsets", zero, 1);
  write_integers(file, "/VTKHDF/Steps/ConnectivityIdOffsets", zero, 1);
  create_group(file, "/VTKHDF/Steps/PointDataOffsets");
  for (const char* name : {"velocity", "strain"})
    write_integers(file, std::string("/VTKHDF/Steps/PointDataOffsets/") + name, first_point);
  for (const char* name : {"node", "part"})
    write_integers(file, std::string("/VTKHDF/Steps/PointDataOffsets/") + name, zero);
}

void VtkhdfExport::close() {
  guard([&] {
    const std::string action = "finishing the file";
    constexpr std::size_t bytes_per_frame = 10 * sizeof(std::int64_t);
    reserve_room(file_.get(), output_.name(), times_s_.size() * bytes_per_frame + room_for_metadata);
    write_steps();
    for (Hdf5Dataset* dataset : {&points_, &velocity_, &strain_}) dataset->close(action);
    checked(H5Fflush(file_.get(), H5F_SCOPE_GLOBAL), action);
    file_.close(action);
    release_reserved_space(temporary_of(output_.name()));
    output_.move_into_place();
  });
}

void VtkhdfExport::guard(const std::function<void()>& write) const {
  try {
    write();
  } catch (const Hdf5Error& error) {
    throw WriteError(write_failure(output_.name(), error.action, error.error_number, error.what()));
  }
}

}  // namespace mssim
