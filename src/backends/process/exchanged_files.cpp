#include "backends/process/exchanged_files.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <functional>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "hdf5/hdf5.h"
#include "text/text.h"

namespace mssim {
namespace {

constexpr const char* shared_memory = "/dev/shm";

static_assert(sizeof(Vec3d) == 3 * sizeof(double), "the file has three numbers per node");

/// A quiet NaN whose payload is text.
constexpr std::uint64_t unwritten = 0x7ff86d737369'6d21;

bool is_unwritten(const Vec3d& vector) {
  return std::ranges::any_of(std::array{vector.x, vector.y, vector.z},
                             [](double number) { return std::bit_cast<std::uint64_t>(number) == unwritten; });
}

std::size_t size_of(std::size_t nodes) { return 2 * sizeof(Vec3d) * nodes; }

/// Moves all bytes between `data` and the file from offset `byte` on; `move` is pread or pwrite. False if it
/// fails, or if the file ends before.
template <class Move, class Byte>
bool move_all(const Move& move, const Descriptor& file, std::size_t byte, Byte* data, std::size_t bytes) {
  while (bytes > 0) {
    const ssize_t count = move(file.get(), data, bytes, static_cast<off_t>(byte));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    data += count;
    byte += static_cast<std::size_t>(count);
    bytes -= static_cast<std::size_t>(count);
  }
  return true;
}

hid_t file_type(double /*number*/) { return H5T_IEEE_F64LE; }
hid_t file_type(std::uint32_t /*number*/) { return H5T_STD_U32LE; }
hid_t memory_type(double /*number*/) { return H5T_NATIVE_DOUBLE; }
hid_t memory_type(std::uint32_t /*number*/) { return H5T_NATIVE_UINT32; }

/// A contiguous dataset; without extents: of one number.
template <class Number>
Hdf5Dataset create(hid_t file, const std::string& path, const std::string& unit,
                   const std::vector<hsize_t>& extents) {
  const std::string action = "creating " + path;
  const Hdf5Space space(H5Screate_simple(static_cast<int>(extents.size()), extents.data(), nullptr), action);
  Hdf5Dataset dataset(
      H5Dcreate2(file, path.c_str(), file_type(Number()), space.get(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
      action);
  if (!unit.empty()) write_attribute(dataset.get(), "unit", std::string_view(unit));
  return dataset;
}

template <class Number>
void write_number(hid_t file, const std::string& path, const std::string& unit, Number number) {
  Hdf5Dataset dataset = create<Number>(file, path, unit, {});
  checked(H5Dwrite(dataset.get(), memory_type(number), H5S_ALL, H5S_ALL, H5P_DEFAULT, &number),
          "writing " + path);
  dataset.close("writing " + path);
}

/// A list of what `of` makes of each row: a number, or several. Written in parts, because all springs of a
/// large scene at once would need as much memory as the scene.
template <class Number, class Row, class Of = std::identity>
void write_list(hid_t file, const std::string& path, const std::string& unit, const std::vector<Row>& rows,
                const Of& of = {}) {
  using Value = std::remove_cvref_t<std::invoke_result_t<Of, const Row&>>;
  constexpr std::size_t rows_at_once = 65536;
  constexpr std::size_t width =
      sizeof(Value) / sizeof(Number);  // NOLINT(bugprone-sizeof-expression): often 1
  const std::string action = "writing " + path;
  Hdf5Dataset dataset = create<Number>(
      file, path, unit,
      width == 1 ? std::vector<hsize_t>{rows.size()} : std::vector<hsize_t>{rows.size(), width});
  std::vector<Value> block;
  const Hdf5Space space(H5Dget_space(dataset.get()), action);
  for (std::size_t first = 0; first < rows.size(); first += block.size()) {
    block.resize(std::min(rows_at_once, rows.size() - first));
    for (std::size_t i = 0; i < block.size(); ++i) block[i] = std::invoke(of, rows[first + i]);
    const std::array<hsize_t, 2> start{first, 0}, count{block.size(), width};
    checked(H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr),
            action);
    const hsize_t numbers = block.size() * width;
    const Hdf5Space memory(H5Screate_simple(1, &numbers, nullptr), action);
    checked(
        H5Dwrite(dataset.get(), memory_type(Number()), memory.get(), space.get(), H5P_DEFAULT, block.data()),
        action);
  }
  dataset.close(action);
}

void write_nodes(hid_t file, const System& system) {
  write_list<double>(file, "/position", "m", system.start.position);
  write_list<double>(file, "/velocity", "m/s", system.start.velocity);
  write_list<double>(file, "/mass", "kg", system.node_mass);
  write_list<std::uint32_t>(file, "/pins", "", system.pins);
}

void write_springs(hid_t file, const System& system) {
  const std::vector<Spring>& springs = system.springs;
  write_list<std::uint32_t>(file, "/springs", "", springs, [](const Spring& spring) {
    return std::array{spring.first, spring.second};
  });
  write_list<double>(file, "/rest_length", "m", springs,
                     [](const Spring& spring) { return double{spring.rest_length}; });
  for (const SpringConstantInfo& constant : spring_constants)
    write_list<double>(file, "/" + std::string(constant.name), std::string(constant.unit), springs,
                       [&](const Spring& spring) { return system.materials[spring.kind].*constant.number; });
  write_list<std::uint32_t>(file, "/kind", "", springs, &Spring::kind);
}

void write_surroundings(hid_t file, const System& system) {
  write_list<double>(file, "/gravity", "m/s^2", std::vector{0., -system.gravity, 0.});
  write_number(file, "/viscous_damping", "1/s", system.viscous_damping);
  create_group(file, "/floor");
  write_number(file, "/floor/height", "m", system.floor.height);
  write_number(file, "/floor/restitution", "", system.floor.restitution);
  write_number(file, "/floor/friction", "", system.floor.friction);
}

void write_topology(hid_t file, const Topology& topology) {
  if (const auto* grid = std::get_if<GridPatch>(&topology)) {
    create_group(file, "/grid");
    write_number(file, "/grid/rows", "", grid->rows);
    write_number(file, "/grid/columns", "", grid->columns);
    write_number(file, "/grid/spacing", "m", grid->spacing);
  }
  if (const auto* mesh = std::get_if<TetrahedralMesh>(&topology))
    write_list<std::uint32_t>(file, "/tetrahedra", "", mesh->tetrahedra);
}

}  // namespace

StateFile::StateFile(std::size_t nodes, const std::filesystem::path& elsewhere) : nodes_(nodes) {
  if (::access(shared_memory, W_OK) == 0) {
    shared_.emplace(shared_memory);
    if (make(shared_->path())) return;
    shared_.reset();
  }
  if (make(elsewhere)) return;
  const int error = errno;
  throw std::runtime_error(
      fmt::format("cannot make {} of {} bytes ({}); {}", path_.string(), size_of(nodes), std::strerror(error),
                  error == EFBIG                       ? "raise the limit on file sizes (ulimit -f)"
                  : error == EMFILE || error == ENFILE ? "raise the limit of open files (ulimit -n)"
                                                       : "set TMPDIR to a folder with more room"));
}

bool StateFile::make(const std::filesystem::path& folder) {
  path_ = folder / "state";
  file_ = Descriptor(::open(path_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600));
  if (!file_.is_open()) return false;
  // Reserve the space now, so that it is not missing during a run.
  const int error = ::posix_fallocate(file_.get(), 0, static_cast<off_t>(size_of(nodes_)));
  errno = error;
  return error == 0;
}

void StateFile::write_at(std::size_t byte, std::string_view bytes) const {
  if (!move_all(::pwrite, file_, byte, bytes.data(), bytes.size()))
    throw std::runtime_error(
        fmt::format("cannot write {} ({}); make room there", path_.string(), std::strerror(errno)));
}

void StateFile::write(const State& state) const {
  write_at(0, bytes_of(state.position));
  write_at(sizeof(Vec3d) * nodes_, bytes_of(state.velocity));
}

void StateFile::clear() const {
  constexpr std::size_t numbers = 8192;
  const std::vector<double> block(numbers, std::bit_cast<double>(unwritten));
  const std::size_t bytes = size_of(nodes_);
  for (std::size_t byte = 0; byte < bytes; byte += numbers * sizeof(double))
    write_at(byte, bytes_of(block).substr(0, bytes - byte));
}

State StateFile::read() const {
  State state;
  const std::size_t half = sizeof(Vec3d) * nodes_;
  const auto read = [&](std::vector<Vec3d>& vectors, std::size_t byte) {
    vectors.resize(nodes_);
    return move_all(::pread, file_, byte, reinterpret_cast<char*>(vectors.data()), half);
  };
  if (!read(state.position, 0) || !read(state.velocity, half)) {
    struct stat status {};
    ::fstat(file_.get(), &status);
    throw StateFileFailure(fmt::format("left a state file of {} instead of {}",
                                       pluralize(static_cast<std::uint64_t>(status.st_size), "byte"),
                                       size_of(nodes_)));
  }
  const auto missing = static_cast<std::size_t>(std::ranges::count_if(state.position, is_unwritten) +
                                                std::ranges::count_if(state.velocity, is_unwritten));
  if (missing > 0)
    throw StateFileFailure(fmt::format("wrote {} of the {} positions and velocities of the state file",
                                       2 * nodes_ - missing, 2 * nodes_));
  return state;
}

void write_system(const std::filesystem::path& file, const System& system) {
  prepare_hdf5();
  try {
    Hdf5File open(H5Fcreate(file.c_str(), H5F_ACC_EXCL, H5P_DEFAULT, H5P_DEFAULT), "creating it");
    write_nodes(open.get(), system);
    write_springs(open.get(), system);
    write_surroundings(open.get(), system);
    write_topology(open.get(), system.topology);
    open.close("closing it");
  } catch (const Hdf5Error& error) {
    throw WriteError(write_failure(file, error.action, error.error_number, error.what()));
  }
}

}  // namespace mssim
