#include "output/h5md_trace.h"

#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>
#include <string_view>

#include "output/atomic_file.h"
#include "output/file_space.h"
#include "output/hdf5_write.h"
#include "output/write_error.h"
#include "output/xdmf.h"

namespace mssim {
namespace {

constexpr std::size_t dimensions = 3;
/// What HDF5 itself adds to a file at a time, at most: a few index nodes and chunks of numbers.
constexpr std::size_t room_for_metadata = 65536;

struct EnergyInfo {
  const char* path;
  double (*value)(const Energy&);
};
constexpr std::array<EnergyInfo, 4> energy_kinds{{
    {"/observables/kinetic_energy", [](const Energy& energy) { return energy.kinetic; }},
    {"/observables/elastic_energy", [](const Energy& energy) { return energy.elastic; }},
    {"/observables/gravitational_energy", [](const Energy& energy) { return energy.gravitational; }},
    {"/observables/total_energy", [](const Energy& energy) { return energy.total(); }},
}};

struct UnitInfo {
  const char* quantity;
  const char* unit;
};
/// In the notation of H5MD's units module. They stand apart, under /parameters/units, because MDAnalysis
/// refuses a `unit` attribute that is a fixed-length string and knows no metres.
constexpr std::array<UnitInfo, 5> units{{
    {"position", "m"},
    {"velocity", "m s-1"},
    {"time", "s"},
    {"mass", "kg"},
    {"energy", "J"},
}};

void write_metadata(hid_t file, const TraceHeader& header) {
  constexpr std::array<std::int64_t, 2> h5md_version{1, 1};
  const Hdf5Group h5md = create_group(file, "/h5md");
  write_attribute(h5md.get(), "version", h5md_version);
  const Hdf5Group author = create_group(file, "/h5md/author");
  write_attribute(author.get(), "name", std::string_view(header.author));
  const Hdf5Group creator = create_group(file, "/h5md/creator");
  write_attribute(creator.get(), "name", std::string_view("mssim"));
  write_attribute(creator.get(), "version", std::string_view(header.creator_version));
}

void write_parameters(hid_t file, const GridPatch& grid, const TraceHeader& header) {
  const Hdf5Group parameters = create_group(file, "/parameters");
  write_text(file, "/parameters/scene", header.scene_json);
  write_text(file, "/parameters/provenance", header.provenance_json);
  write_attribute(parameters.get(), "backend", std::string_view(header.backend));
  write_attribute(parameters.get(), "integrator", std::string_view(header.integrator));
  write_attribute(parameters.get(), "dt_s", header.dt_s);
  write_attribute(parameters.get(), "rows", std::int64_t{grid.rows});
  write_attribute(parameters.get(), "columns", std::int64_t{grid.columns});
  const Hdf5Group units_group = create_group(file, "/parameters/units");
  for (const auto& [quantity, unit] : units)
    write_attribute(units_group.get(), quantity, std::string_view(unit));
}

void write_mass(hid_t file, const System& system) {
  const std::array<hsize_t, 1> shape{system.nodes()};
  Hdf5Dataset mass = create_dataset(file, "/particles/cloth/mass", H5T_IEEE_F64LE, shape, false,
                                    chunked(shape, Packing::deflated));
  checked(H5Dwrite(mass.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, system.node_mass.data()),
          "writing masses");
  mass.close("writing masses");
}

void write_springs(hid_t file, const System& system) {
  const Hdf5Group connectivity = create_group(file, "/connectivity");
  if (system.springs.empty()) return;
  std::vector<std::uint32_t> ends;
  ends.reserve(2 * system.springs.size());
  for (const Spring& spring : system.springs) {
    ends.push_back(spring.first);
    ends.push_back(spring.second);
  }
  constexpr hsize_t springs_per_chunk = 65536;
  const std::array<hsize_t, 2> shape{system.springs.size(), 2};
  const std::array<hsize_t, 2> chunk{std::min(shape[0], springs_per_chunk), 2};
  const Hdf5Properties properties = chunked(chunk, Packing::deflated);
  // Readers of H5MD pass over tuples that hold the fill value. HDF5's own is 0, a real node.
  constexpr std::uint32_t no_node = std::numeric_limits<std::uint32_t>::max();
  checked(H5Pset_fill_value(properties.get(), H5T_NATIVE_UINT32, &no_node), "setting a fill value");
  Hdf5Dataset springs =
      create_dataset(file, "/connectivity/springs", H5T_STD_U32LE, shape, false, properties);
  checked(H5Dwrite(springs.get(), H5T_NATIVE_UINT32, H5S_ALL, H5S_ALL, H5P_DEFAULT, ends.data()),
          "writing springs");
  write_reference(springs.get(), "particles_group", file, "/particles/cloth");
  springs.close("writing springs");
}

/// Series of single numbers. Their chunks hold many frames and are rewritten in place at every flush, which
/// needs chunks whose stored size never changes: no deflation.
Hdf5Dataset create_number_series(hid_t file, const std::string& path, hid_t type) {
  constexpr std::array<hsize_t, 1> none{0}, frames_per_chunk{256};
  return create_dataset(file, path, type, none, true, chunked(frames_per_chunk, Packing::plain));
}

Hdf5Dataset create_vector_series(hid_t file, const std::string& path, hsize_t nodes) {
  return create_dataset(file, path, H5T_IEEE_F32LE, std::array<hsize_t, 3>{0, nodes, dimensions}, true,
                        chunked(std::array<hsize_t, 3>{1, nodes, dimensions}, Packing::deflated));
}

void link_step_and_time(hid_t file, const std::string& element) {
  for (const char* name : {"/step", "/time"})
    checked(H5Lcreate_hard(file, ("/particles/cloth/position" + std::string(name)).c_str(), H5L_SAME_LOC,
                           (element + name).c_str(), H5P_DEFAULT, H5P_DEFAULT),
            "linking " + element + name);
}

/// Frames that can be found in a trace, 0 when it cannot be opened.
std::size_t count_frames(const std::filesystem::path& trace) {
  try {
    const Hdf5File file(H5Fopen(trace.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), "opening");
    const Hdf5Dataset step(H5Dopen2(file.get(), "/particles/cloth/position/step", H5P_DEFAULT), "opening");
    const Hdf5Space space(H5Dget_space(step.get()), "opening");
    return static_cast<std::size_t>(checked(H5Sget_simple_extent_npoints(space.get()), "counting"));
  } catch (const Hdf5Error&) {
    return 0;
  }
}

}  // namespace

H5mdTrace::H5mdTrace(std::filesystem::path file, const System& system, const TraceHeader& header)
    : file_name_(std::move(file)),
      grid_(std::get<GridPatch>(system.topology)),
      buffer_(dimensions * system.nodes()) {
  if (system.nodes() == 0 || system.nodes() != grid_.nodes())
    throw std::invalid_argument("a trace needs a system whose nodes form a grid");
  prepare_hdf5();
  require_replaceable(file_name_);
  require_replaceable(temporary_of(file_name_));
  require_replaceable(xdmf_of(file_name_));
  if (xdmf_of(file_name_) == file_name_)
    throw WriteError("cannot write " + file_name_.string() +
                     ": its XDMF would have the same name; choose a name that ends in .h5");
  guard([&] { create(system, header); });
}

H5mdTrace::~H5mdTrace() { give_up(); }

void H5mdTrace::create(const System& system, const TraceHeader& header) {
  const std::string temporary = temporary_of(file_name_).string();
  // The default, oldest format: the newer ones leave a file that only h5clear can open after a crash.
  file_ = Hdf5File(H5Fcreate(temporary.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT),
                   "creating " + temporary);
  owns_temporary_ = true;
  write_metadata(file_.get(), header);
  write_parameters(file_.get(), grid_, header);
  create_series(system);
  write_mass(file_.get(), system);
  write_springs(file_.get(), system);
  checked(H5Fflush(file_.get(), H5F_SCOPE_GLOBAL), "writing the head of the trace");
}

void H5mdTrace::create_series(const System& system) {
  const hid_t file = file_.get();
  create_group(file, "/particles");
  create_group(file, "/particles/cloth");
  const Hdf5Group box = create_group(file, "/particles/cloth/box");
  constexpr std::array<std::string_view, dimensions> boundary{"none", "none", "none"};
  write_attribute(box.get(), "dimension", std::int64_t{dimensions});
  write_attribute(box.get(), "boundary", boundary);

  create_group(file, "/particles/cloth/position");
  create_group(file, "/particles/cloth/velocity");
  step_ = create_number_series(file, "/particles/cloth/position/step", H5T_STD_I64LE);
  time_ = create_number_series(file, "/particles/cloth/position/time", H5T_IEEE_F64LE);
  position_ = create_vector_series(file, "/particles/cloth/position/value", system.nodes());
  velocity_ = create_vector_series(file, "/particles/cloth/velocity/value", system.nodes());
  link_step_and_time(file, "/particles/cloth/velocity");

  create_group(file, "/observables");
  for (const EnergyInfo& energy : energy_kinds) {
    create_group(file, energy.path);
    energies_.push_back(create_number_series(file, energy.path + std::string("/value"), H5T_IEEE_F64LE));
    link_step_and_time(file, energy.path);
  }
}

void H5mdTrace::write_frame(std::int64_t step, double time_s, const State& state, const Energy& energy) {
  const std::size_t nodes = grid_.nodes();
  if (state.position.size() != nodes || state.velocity.size() != nodes)
    throw std::invalid_argument("a frame's state has another size than the trace's system");
  if (!times_s_.empty() && !(step > last_step_ && time_s > times_s_.back()))
    throw std::invalid_argument("a trace's steps and times must increase");
  guard([&] { append(step, time_s, state, energy); });
  last_step_ = step;
  times_s_.push_back(time_s);
}

void H5mdTrace::append(std::int64_t step, double time_s, const State& state, const Energy& energy) {
  const hsize_t frame = times_s_.size();
  reserve(2 * buffer_.size() * sizeof(float) + room_for_metadata);
  const auto write_vectors = [&](const Hdf5Dataset& dataset, const std::string& name,
                                 const std::vector<Vec3d>& vectors) {
    std::size_t i = 0;
    for (const Vec3d& vector : vectors)
      for (const double component : {vector.x, vector.y, vector.z})
        buffer_[i++] = static_cast<float>(component);
    write_row(dataset, name, frame, H5T_NATIVE_FLOAT, buffer_.data());
  };
  write_vectors(position_, "positions", state.position);
  write_vectors(velocity_, "velocities", state.velocity);
  for (std::size_t kind = 0; kind < energy_kinds.size(); ++kind) {
    const double value = energy_kinds[kind].value(energy);
    write_row(energies_[kind], "energies", frame, H5T_NATIVE_DOUBLE, &value);
  }
  write_row(time_, "times", frame, H5T_NATIVE_DOUBLE, &time_s);
  write_row(step_, "steps", frame, H5T_NATIVE_INT64, &step);
  // Only here does a full disk show, and only what is flushed survives a kill.
  checked(H5Fflush(file_.get(), H5F_SCOPE_GLOBAL), "writing frame " + std::to_string(frame));
}

void H5mdTrace::close() {
  guard([&] {
    const std::string action = "finishing the trace";
    reserve(room_for_metadata + times_s_.size() * xdmf_bytes_per_frame);
    map_frames_for_xdmf(file_.get(), grid_, times_s_.size());
    checked(H5Fflush(file_.get(), H5F_SCOPE_GLOBAL), action);
    for (Hdf5Dataset* dataset : {&step_, &time_, &position_, &velocity_}) dataset->close(action);
    for (Hdf5Dataset& dataset : energies_) dataset.close(action);
    file_.close(action);
    release_reserved_space(temporary_of(file_name_));
    move_into_place(file_name_);
    owns_temporary_ = false;
  });
  write_xdmf(file_name_, grid_, times_s_);
}

void H5mdTrace::reserve(std::size_t bytes) {
  // HDF5 spoils a file that it cannot write to its end: the head then promises more than there is.
  void* descriptor = nullptr;
  checked(H5Fget_vfd_handle(file_.get(), H5P_DEFAULT, &descriptor), "asking for the file descriptor");
  const int error_number = reserve_space(*static_cast<const int*>(descriptor), bytes);
  if (error_number != 0)
    throw WriteError(
        write_failure(file_name_, "reserving " + std::to_string(bytes) + " bytes", error_number));
}

void H5mdTrace::guard(const std::function<void()>& write) {
  const auto explain = [&](const std::string& message) {
    const std::size_t kept = give_up();
    if (kept > 0)
      return message + "; " + temporary_of(file_name_).string() +
             " keeps the frames written before: " + std::to_string(kept);
    return times_s_.empty() ? message : message + "; the frames written before could not be saved";
  };
  try {
    write();
  } catch (const Hdf5Error& error) {
    throw WriteError(explain(write_failure(file_name_, error.action, error.error_number, error.what())));
  } catch (const WriteError& error) {
    throw WriteError(explain(error.what()));
  }
}

/// Closes everything without complaint and removes the temporary file unless it holds frames that can be
/// read. Returns how many.
std::size_t H5mdTrace::give_up() {
  if (!owns_temporary_) return 0;
  owns_temporary_ = false;
  for (Hdf5Dataset* dataset : {&step_, &time_, &position_, &velocity_}) *dataset = {};
  energies_.clear();
  file_ = {};
  const std::filesystem::path temporary = temporary_of(file_name_);
  release_reserved_space(temporary);
  const std::size_t kept = times_s_.empty() ? 0 : std::min(times_s_.size(), count_frames(temporary));
  std::error_code ignored;
  if (kept == 0) std::filesystem::remove(temporary, ignored);
  return kept;
}

}  // namespace mssim
