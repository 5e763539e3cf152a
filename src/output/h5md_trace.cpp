#include "output/h5md_trace.h"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "output/atomic_file.h"
#include "output/file_space.h"
#include "output/h5md_body.h"
#include "output/hdf5_write.h"
#include "output/write_error.h"

namespace mssim {
namespace {

constexpr std::size_t dimensions = 3;
/// What HDF5 itself adds to a file at a time, at most: a few index nodes and chunks of numbers.
constexpr std::size_t room_for_metadata = 65536;

struct ObservableInfo {
  const char* path;
  bool is_loss;
  double (*value)(const Energy&, const EnergyLosses&);
};
constexpr std::array<ObservableInfo, 8> observable_kinds{{
    {"/observables/kinetic_energy", false, [](const Energy& energy, auto&) { return energy.kinetic; }},
    {"/observables/elastic_energy", false, [](const Energy& energy, auto&) { return energy.elastic; }},
    {"/observables/gravitational_energy", false,
     [](const Energy& energy, auto&) { return energy.gravitational; }},
    {"/observables/total_energy", false, [](const Energy& energy, auto&) { return energy.total(); }},
    {"/observables/damping_loss", true, [](auto&, const EnergyLosses& losses) { return losses.damping; }},
    {"/observables/friction_loss", true, [](auto&, const EnergyLosses& losses) { return losses.friction; }},
    {"/observables/bounce_loss", true, [](auto&, const EnergyLosses& losses) { return losses.bounce; }},
    {"/observables/integration_loss", true,
     [](auto&, const EnergyLosses& losses) { return losses.integration; }},
}};

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

void link_step_and_time(hid_t file, const std::string& from, const std::string& to) {
  for (const char* name : {"/step", "/time"})
    checked(H5Lcreate_hard(file, (from + name).c_str(), H5L_SAME_LOC, (to + name).c_str(), H5P_DEFAULT,
                           H5P_DEFAULT),
            "linking " + to + name);
}

/// Frames that can be found in a trace, 0 when it cannot be opened.
std::size_t count_frames(const std::filesystem::path& trace) {
  try {
    const Hdf5File file(H5Fopen(trace.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), "opening");
    const Hdf5Dataset step(H5Dopen2(file.get(), "/observables/total_energy/step", H5P_DEFAULT), "opening");
    const Hdf5Space space(H5Dget_space(step.get()), "opening");
    return static_cast<std::size_t>(checked(H5Sget_simple_extent_npoints(space.get()), "counting"));
  } catch (const Hdf5Error&) {
    return 0;
  }
}

}  // namespace

H5mdTrace::H5mdTrace(std::filesystem::path file, const System& system, const TraceHeader& header,
                     const Surface& body)
    : file_name_(std::move(file)),
      mesh_(xdmf_mesh_of(system, body)),
      with_losses_(header.with_losses),
      buffer_(dimensions * system.nodes()) {
  require_fitting_topology(system);
  require_fitting_body(system, body);
  prepare_hdf5();
  require_replaceable(file_name_);
  require_replaceable(temporary_of(file_name_));
  require_replaceable(xdmf_of(file_name_));
  if (xdmf_of(file_name_) == file_name_)
    throw WriteError("cannot write " + file_name_.string() +
                     ": its XDMF would have the same name; choose a name that ends in .h5");
  guard([&] { create(system, header, body); });
}

H5mdTrace::~H5mdTrace() { give_up(); }

void H5mdTrace::create(const System& system, const TraceHeader& header, const Surface& body) {
  const std::string temporary = temporary_of(file_name_).string();
  // The default, oldest format: the newer ones leave a file that only h5clear can open after a crash.
  file_ = Hdf5File(H5Fcreate(temporary.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT),
                   "creating " + temporary);
  owns_temporary_ = true;
  write_h5md_head(file_.get(), particles(), system, header);
  write_static_body(file_.get(), body);
  create_series(system.nodes());
  checked(H5Fflush(file_.get(), H5F_SCOPE_GLOBAL), "writing the head of the trace");
}

void H5mdTrace::create_series(std::size_t nodes) {
  const hid_t file = file_.get();
  const std::string position = particles() + "/position", velocity = particles() + "/velocity";
  create_group(file, position);
  create_group(file, velocity);
  step_ = create_number_series(file, position + "/step", H5T_STD_I64LE);
  time_ = create_number_series(file, position + "/time", H5T_IEEE_F64LE);
  position_ = create_vector_series(file, position + "/value", nodes);
  velocity_ = create_vector_series(file, velocity + "/value", nodes);
  link_step_and_time(file, position, velocity);

  create_group(file, "/observables");
  for (const ObservableInfo& observable : observable_kinds) {
    if (observable.is_loss && !with_losses_) continue;
    create_group(file, observable.path);
    observables_.push_back(
        create_number_series(file, observable.path + std::string("/value"), H5T_IEEE_F64LE));
    link_step_and_time(file, position, observable.path);
  }
}

void H5mdTrace::write_frame(std::int64_t step, double time_s, const State& state, const Energy& energy,
                            const std::optional<EnergyLosses>& losses) {
  if (dimensions * state.position.size() != buffer_.size() ||
      dimensions * state.velocity.size() != buffer_.size())
    throw std::invalid_argument("a frame's state has another size than the trace's system");
  if (!times_s_.empty() && !(step > last_step_ && time_s > times_s_.back()))
    throw std::invalid_argument("a trace's steps and times must increase");
  if (losses.has_value() != with_losses_)
    throw std::invalid_argument("a frame has losses where the trace's header says otherwise, or has none");
  guard([&] { append(step, time_s, state, energy, losses.value_or(EnergyLosses{})); });
  last_step_ = step;
  times_s_.push_back(time_s);
}

void H5mdTrace::append(std::int64_t step, double time_s, const State& state, const Energy& energy,
                       const EnergyLosses& losses) {
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
  for (std::size_t kind = 0; kind < observables_.size(); ++kind) {
    const double value = observable_kinds[kind].value(energy, losses);
    write_row(observables_[kind], "energies", frame, H5T_NATIVE_DOUBLE, &value);
  }
  write_row(time_, "times", frame, H5T_NATIVE_DOUBLE, &time_s);
  write_row(step_, "steps", frame, H5T_NATIVE_INT64, &step);
  // Only here does a full disk show, and only what is flushed survives a kill.
  checked(H5Fflush(file_.get(), H5F_SCOPE_GLOBAL), "writing frame " + std::to_string(frame));
}

void H5mdTrace::close() {
  guard([&] {
    const std::string action = "finishing the trace";
    reserve(room_for_metadata + times_s_.size() * mesh_.parts.size() * xdmf_bytes_per_part_and_frame);
    map_frames_for_xdmf(file_.get(), mesh_, times_s_.size());
    checked(H5Fflush(file_.get(), H5F_SCOPE_GLOBAL), action);
    for (Hdf5Dataset* dataset : {&step_, &time_, &position_, &velocity_}) dataset->close(action);
    for (Hdf5Dataset& observable : observables_) observable.close(action);
    file_.close(action);
    release_reserved_space(temporary_of(file_name_));
    move_into_place(file_name_);
    owns_temporary_ = false;
  });
  write_xdmf(file_name_, mesh_, times_s_);
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
  observables_.clear();
  file_ = {};
  const std::filesystem::path temporary = temporary_of(file_name_);
  release_reserved_space(temporary);
  const std::size_t kept = times_s_.empty() ? 0 : std::min(times_s_.size(), count_frames(temporary));
  std::error_code ignored;
  if (kept == 0) std::filesystem::remove(temporary, ignored);
  return kept;
}

}  // namespace mssim
