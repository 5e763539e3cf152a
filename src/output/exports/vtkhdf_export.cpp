#include "output/exports/vtkhdf_export.h"

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "hdf5/hdf5.h"
#include "platform/files.h"

namespace mssim {
namespace {

/// What HDF5 itself adds to a file at a time, at most.
constexpr std::size_t room_for_metadata = 65536;

void write_integers(hid_t file, const std::string& path, const std::vector<std::int64_t>& numbers,
                    std::size_t columns = 0) {
  std::vector<hsize_t> shape{numbers.size()};
  if (columns > 0) shape = {numbers.size() / columns, columns};
  write_array(file, path, H5T_STD_I64LE, H5T_NATIVE_INT64, shape, numbers.data());
}

/// Cells with so many corners each; `type` is VTK's number of their kind.
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
  const std::array<hsize_t, 2> no_vectors{0, 3}, vectors{points, 3};
  const std::array<hsize_t, 1> none{0}, numbers{points};
  points_ =
      create_dataset(file, "/VTKHDF/Points", type, no_vectors, true, chunked(vectors, Packing::deflated));
  velocity_ = create_dataset(file, "/VTKHDF/PointData/velocity", type, no_vectors, true,
                             chunked(vectors, Packing::deflated));
  strain_ =
      create_dataset(file, "/VTKHDF/PointData/strain", type, none, true, chunked(numbers, Packing::deflated));
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

/// Where each frame begins in the datasets; what is there once begins at 0 for all.
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
