// Traces in which an input changes datasets, attributes and extents. The bytes of the HDF5 file itself stay
// those of a whole file: HDF5 crashes on some that are damaged, which TraceReader finds out in a process of
// its own.

#include <array>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "fuzz_checks.h"
#include "hdf5/hdf5.h"
#include "hdf5/hdf5_table.h"
#include "output/traces/h5md_trace.h"
#include "output/traces/trace_reader.h"
#include "platform/files.h"
#include "tests/support/trace_systems.h"

namespace mssim {
namespace {

System cloth() {
  System system;
  const GridPatch grid{3, 4, 0.01};
  system.topology = grid;
  system.springs = springs_of(grid);
  system.materials.resize(grid_spring_kinds.size());
  return system;
}

System body() {
  System system;
  system.topology = TetrahedralMesh{{{0, 1, 2, 3}, {0, 2, 1, 4}}};
  system.springs = {{0, 1, 1, 0}, {0, 2, 1, 0}, {3, 4, 1, 0}};
  system.materials.resize(1);
  system.start.position.resize(5);
  return system;
}

/// The bytes of a trace of two frames.
std::string trace_of(System system, const Surface& surface = {}) {
  if (const auto* grid = std::get_if<GridPatch>(&system.topology))
    system.start.position.resize(grid->nodes());
  system.start.velocity.resize(system.nodes());
  system.node_mass.assign(system.nodes(), 1);
  const TemporaryFolder folder;
  H5mdTrace trace(folder.path() / "fuzz.h5", system, {"Ada", "1", "{}", "{}", "openmp", "rk4", 1e-3},
                  surface);
  trace.write_frame(0, 0, system.start, {});
  trace.write_frame(1, 1e-3, system.start, {});
  trace.close();
  return read_file(folder.path() / "fuzz.h5");
}

constexpr std::array<const char*, 6> of_all{"/connectivity/springs", "/parameters/springs/rest_length",
                                            "/parameters/scene",     "/connectivity/tetrahedra",
                                            "/connectivity/joints",  "/h5md"};
constexpr std::array<const char*, 5> of_particles{"position/value", "velocity/value", "position/step",
                                                  "position/time", "position"};
constexpr std::array<const char*, 11> of_garments{"/parameters/panels/name",       "/parameters/panels/rows",
                                                  "/parameters/panels/columns",    "/parameters/seams",
                                                  "/parameters/panels/layer",      "/parameters/panels/flat",
                                                  "/parameters/panels/first_node", "/body/points",
                                                  "/parameters/joints/seam",       "/body/triangles",
                                                  "/parameters/joints/edge_share"};

std::string path_of(std::uint8_t number, const std::string& particles) {
  const std::size_t at = number % (of_all.size() + of_particles.size() + of_garments.size());
  if (at < of_all.size()) return of_all[at];
  if (at < of_all.size() + of_particles.size())
    return "/particles/" + particles + "/" + of_particles[at - of_all.size()];
  return of_garments[at - of_all.size() - of_particles.size()];
}

/// One change of a file, as an input holds it.
struct Edit {
  std::uint8_t action, target;
  std::uint16_t place;
  std::array<std::uint8_t, 8> value;
};
static_assert(sizeof(Edit) == 12);

template <class Number>
Number number_in(const Edit& edit) {
  Number number{};
  std::memcpy(&number, edit.value.data(), sizeof(Number));
  return number;
}

/// Puts a number of the input's bits into a dataset.
void set_number(hid_t file, const std::string& path, const Edit& edit) {
  const Hdf5Dataset dataset(H5Dopen2(file, path.c_str(), H5P_DEFAULT), path);
  const Hdf5Type type(H5Dget_type(dataset.get()), path);
  const Hdf5Space space(H5Dget_space(dataset.get()), path);
  const auto count = static_cast<std::size_t>(H5Sget_simple_extent_npoints(space.get()));
  const std::size_t size = H5Tget_size(type.get());
  if (H5Tget_class(type.get()) == H5T_STRING || size > 8 || count == 0 || count > 1000) return;
  std::vector<char> bytes(count * size);
  checked(H5Dread(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()), path);
  std::memcpy(bytes.data() + edit.place % count * size, edit.value.data(), size);
  checked(H5Dwrite(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()), path);
}

/// Makes a dataset of zeros of another type and other extents.
void replace(hid_t file, const std::string& path, const Edit& edit) {
  const std::array types{H5T_IEEE_F64LE, H5T_IEEE_F32LE, H5T_STD_U32LE,
                         H5T_STD_I64LE,  H5T_STD_I8LE,   H5T_IEEE_F32BE};
  const hid_t type = types.at(edit.value[0] % types.size());
  std::vector<hsize_t> shape;
  for (std::size_t axis = 0; axis < edit.value[1] % 4U; ++axis)
    shape.push_back(1U + edit.value[2 + axis] % 32U);
  if (shape.empty()) return;
  checked(H5Ldelete(file, path.c_str(), H5P_DEFAULT), path);
  const std::vector<char> zeros(32 * 32 * 32 * 8, 0);
  write_array(file, path, type, type, shape, zeros.data());
}

void set_extent(hid_t file, const std::string& path, const Edit& edit) {
  const Hdf5Dataset dataset(H5Dopen2(file, path.c_str(), H5P_DEFAULT), path);
  const Hdf5Space space(H5Dget_space(dataset.get()), path);
  std::array<hsize_t, 3> shape{};
  if (H5Sget_simple_extent_ndims(space.get()) > 3) return;
  checked(H5Sget_simple_extent_dims(space.get(), shape.data(), nullptr), path);
  constexpr hsize_t long_to_shrink = 100000;  // HDF5 looks for each chunk that is lost
  if (shape.front() > long_to_shrink) return;
  shape.front() = number_in<std::uint64_t>(edit) >> (edit.place % 64);
  checked(H5Dset_extent(dataset.get(), shape.data()), path);
}

void set_attribute(hid_t file, const Edit& edit) {
  const std::array names{"rows", "columns", "dt_s"};
  const std::string name = names.at(edit.target % names.size());
  const Hdf5Group parameters(H5Gopen2(file, "/parameters", H5P_DEFAULT), "parameters");
  H5Adelete(parameters.get(), name.c_str());
  if (edit.place % 2 != 0)
    write_attribute(parameters.get(), name, number_in<double>(edit));
  else
    write_attribute(parameters.get(), name, number_in<std::int64_t>(edit));
}

void apply(hid_t file, const std::string& particles, const Edit& edit) {
  const std::string path = path_of(edit.target, particles);
  try {
    switch (edit.action % 8) {
      case 0:
        checked(H5Ldelete(file, path.c_str(), H5P_DEFAULT), path);
        break;
      case 1:
        replace(file, path, edit);
        break;
      case 2:
        set_extent(file, path, edit);
        break;
      case 3:
        set_attribute(file, edit);
        break;
      default:
        set_number(file, path, edit);
    }
  } catch (const Hdf5Error&) {  // what the trace does not have cannot be changed
  }
}

void check(hid_t file, const TraceContent& content) {
  const std::size_t nodes = content.nodes;
  require(nodes > 0 && !content.step.empty() && content.step.size() == content.time_s.size(),
          "there are frames");
  for (const auto& [first, second] : content.springs)
    require(first < nodes && second < nodes, "springs join nodes");
  require(content.rest_length.empty() || content.rest_length.size() == content.springs.size(),
          "springs have lengths");
  std::size_t next = 0;
  for (const GarmentPanel& sheet : content.shape.sheets) {
    require(sheet.first_node == next, "sheets follow each other");
    next += std::size_t{sheet.rows} * sheet.columns;
  }
  require(content.shape.sheets.empty() || next == nodes, "sheets have all nodes");
  for (const Tetrahedron& tetrahedron : content.shape.tetrahedra)
    for (const std::uint32_t corner : tetrahedron) require(corner < nodes, "corners are nodes");
  for (const auto& triangle : content.body.triangles)
    for (const std::uint32_t corner : triangle)
      require(corner < content.body.points.size(), "triangles have corners");
  const Hdf5Table positions(file, particles_group(content) + "/position/value", {Hdf5Table::any, nodes, 3});
  for (std::size_t frame = 0; frame < content.step.size(); ++frame)
    require(positions.read<double>(frame, 1).size() == 3 * nodes, "a frame has all nodes");
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::array<std::pair<std::string, std::string>, 3> traces{
      {{"cloth", trace_of(cloth())},
       {"bodies", trace_of(body())},
       {"garment", trace_of(two_panels(), small_tetrahedron())}}};
  if (size == 0) return 0;
  const auto& [particles, bytes] = traces.at(data[0] % traces.size());
  const Hdf5Properties access(H5Pcreate(H5P_FILE_ACCESS), "access");
  checked(H5Pset_fapl_core(access.get(), 65536, 0), "a file in memory");
  std::string image = bytes;
  checked(H5Pset_file_image(access.get(), image.data(), image.size()), "a file in memory");
  const Hdf5File file(H5Fopen("fuzz.h5", H5F_ACC_RDWR, access.get()), "opening");
  constexpr std::size_t most_edits = 16;
  for (std::size_t at = 1, edits = 0; at + sizeof(Edit) <= size && edits < most_edits;
       at += sizeof(Edit), ++edits) {
    Edit edit{};
    std::memcpy(&edit, data + at, sizeof(Edit));
    apply(file.get(), particles, edit);
  }
  checked(H5Fflush(file.get(), H5F_SCOPE_GLOBAL), "flushing");
  unless_refused<std::invalid_argument>([&] {
    return unless_refused<std::runtime_error>([&] {
      const TraceContent content = read_trace_content(file.get());
      check(file.get(), content);
      return true;
    });
  });
  return 0;
}

}  // namespace mssim
