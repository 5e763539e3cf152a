#include "output/traces/h5md_trace.h"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "garment/output/h5md_garment.h"
#include "hdf5/hdf5_table.h"
#include "text/text.h"

namespace mssim {
namespace {

/// Of vectors in a file.
constexpr std::size_t dimensions = 3;
static_assert(sizeof(Vec3d) == dimensions * sizeof(double));

struct UnitInfo {
  const char* quantity;
  const char* unit;
};
/// In the notation of H5MD's units module. They are separate, in /parameters/units, because MDAnalysis
/// refuses a `unit` attribute that is a fixed-length string and does not know metres; without any it needs
/// convert_units=False.
constexpr auto units = std::to_array<UnitInfo>({
    {"position", "m"},
    {"velocity", "m s-1"},
    {"time", "s"},
    {"mass", "kg"},
    {"energy", "J"},
    {"rest_length", "m"},
});

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

void write_parameters(hid_t file, const System& system, const NodeShape& shape, const TraceHeader& header) {
  const Hdf5Group parameters = create_group(file, "/parameters");
  write_text(file, "/parameters/scene", header.scene_json);
  write_text(file, "/parameters/provenance", header.provenance_json);
  write_attribute(parameters.get(), "backend", std::string_view(header.backend));
  write_attribute(parameters.get(), "integrator", std::string_view(header.integrator));
  write_attribute(parameters.get(), "dt_s", header.dt_s);
  if (shape.in_panels) {
    write_garment(file, std::get<Garment>(system.topology));
  } else if (!shape.sheets.empty()) {
    write_attribute(parameters.get(), "rows", std::int64_t{shape.sheets.front().rows});
    write_attribute(parameters.get(), "columns", std::int64_t{shape.sheets.front().columns});
  }
  const Hdf5Group units_group = create_group(file, "/parameters/units");
  for (const auto& [quantity, unit] : units)
    write_attribute(units_group.get(), quantity, std::string_view(unit));
  for (const SpringConstantInfo& constant : spring_constants)
    write_attribute(units_group.get(), std::string(constant.name), constant.h5md_unit);
}

void create_particles(hid_t file, const std::string& particles) {
  create_group(file, "/particles");
  create_group(file, particles);
  const Hdf5Group box = create_group(file, particles + "/box");
  constexpr std::array<std::string_view, 3> boundary{"none", "none", "none"};
  write_attribute(box.get(), "dimension", std::int64_t{boundary.size()});
  write_attribute(box.get(), "boundary", boundary);
}

/// Writes the data from which strains and forces are computed, in the order of /connectivity/springs.
void write_springs(hid_t file, const System& system) {
  if (system.springs.empty()) return;
  const auto write = [&](std::string_view name, const auto& number_of) {
    write_numbers(file, "/parameters/springs/" + std::string(name),
                  mapped<double>(system.springs, [&](const Spring& spring) {
                    return number_of(spring, system.materials[spring.kind]);
                  }));
  };
  create_group(file, "/parameters/springs");
  write("rest_length",
        [](const Spring& spring, const SpringMaterial&) { return double{spring.rest_length}; });
  for (const SpringConstantInfo& constant : spring_constants)
    write(constant.name,
          [&](const Spring&, const SpringMaterial& material) { return material.*constant.number; });
}

void write_connectivity(hid_t file, const std::string& particles, const System& system,
                        const NodeShape& shape) {
  const Hdf5Group connectivity = create_group(file, "/connectivity");
  const auto ends = mapped<std::array<std::uint32_t, 2>>(system.springs, [](const Spring& spring) {
    return std::array{spring.first, spring.second};
  });
  write_tuples<2>(file, "/connectivity/springs", particles, ends);
  write_tuples<4>(file, tetrahedra_dataset, particles, shape.tetrahedra);
  if (shape.in_panels) write_joints(file, particles, std::get<Garment>(system.topology));
}

/// Writes the body, unless it is empty; HDF5 rounds its points to single precision. Throws Hdf5Error.
void write_static_body(hid_t file, const Surface& body) {
  if (body.triangles.empty()) return;
  create_group(file, "/body");
  write_array(file, body_points_dataset, H5T_IEEE_F32LE, H5T_NATIVE_DOUBLE,
              std::array<hsize_t, 2>{body.points.size(), dimensions}, body.points.data());
  write_array(file, body_triangles_dataset, H5T_STD_U32LE, H5T_NATIVE_UINT32,
              std::array<hsize_t, 2>{body.triangles.size(), 3}, body.triangles.data());
}

/// Upper bound of what HDF5 adds to a file at a time: a few index nodes and chunks of numbers.
constexpr std::size_t room_for_metadata = 65536;

struct ObservableInfo {
  const char* path;
  bool is_loss;
  double (*value)(const Energy&, const EnergyLosses&);
};
constexpr auto observable_kinds = std::to_array<ObservableInfo>({
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
});

/// Chunks of series of single numbers hold many frames and are rewritten in place at every flush, which
/// requires chunks of constant stored size: no deflation.
Hdf5Dataset create_number_series(hid_t file, const std::string& path, hid_t type) {
  constexpr std::array<hsize_t, 1> frames_per_chunk{256};
  return create_series(file, path, type, frames_per_chunk, Packing::plain);
}

void link_step_and_time(hid_t file, const std::string& from, const std::string& to) {
  for (const char* name : {"/step", "/time"})
    checked(H5Lcreate_hard(file, (from + name).c_str(), H5L_SAME_LOC, (to + name).c_str(), H5P_DEFAULT,
                           H5P_DEFAULT),
            "linking " + to + name);
}

/// Number of frames in a trace, 0 if it cannot be opened.
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

void require_fitting_body(const NodeShape& shape, const Surface& body) {
  if (body.points.empty() && body.triangles.empty()) return;
  if (!shape.in_panels) throw std::invalid_argument("only a garment's trace has a body that does not move");
  const bool fits = std::ranges::all_of(body.triangles, [&](const auto& corners) {
    return std::ranges::all_of(corners, [&](std::uint32_t corner) { return corner < body.points.size(); });
  });
  if (body.triangles.empty() || !fits)
    throw std::invalid_argument("a trace's body needs triangles between its points");
}

H5mdTrace::H5mdTrace(std::filesystem::path file, const System& system, const TraceHeader& header,
                     const Surface& body)
    : output_(std::move(file)), with_losses_(header.with_losses) {
  const NodeShape shape = shape_of(system.topology);
  require_fitting_shape(shape, system.nodes());
  if (const auto* garment = std::get_if<Garment>(&system.topology))
    require_fitting_garment(*garment, system.nodes());
  require_fitting_body(shape, body);
  mesh_ = xdmf_mesh_of(shape, system.nodes(), body, header.in_double);
  prepare_hdf5();
  if (xdmf_of(name()) == name())
    throw WriteError("cannot write " + name().string() +
                     ": its XDMF would have the same name; choose a name that ends in .h5");
  AtomicFile(xdmf_of(name())).remove();  // finds what cannot be written before anything is simulated
  guard([&] { create(system, shape, header, body); });
}

H5mdTrace::~H5mdTrace() { give_up(); }

void H5mdTrace::create(const System& system, const NodeShape& shape, const TraceHeader& header,
                       const Surface& body) {
  const std::string temporary = temporary_of(name()).string();
  // The default, oldest format: newer ones leave a file that only h5clear can open after a crash.
  file_ = Hdf5File(H5Fcreate(temporary.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT),
                   "creating " + temporary);
  const hid_t file = file_.get();
  write_metadata(file, header);
  write_parameters(file, system, shape, header);
  create_particles(file, particles());
  write_numbers(file, particles() + "/mass", system.node_mass);
  write_connectivity(file, particles(), system, shape);
  write_springs(file, system);
  write_static_body(file, body);
  create_all_series(system);
  checked(H5Fflush(file, H5F_SCOPE_GLOBAL), "writing the head of the trace");
}

void H5mdTrace::create_all_series(const System& system) {
  const hid_t file = file_.get();
  const std::array<hsize_t, 3> frame{1, system.nodes(), dimensions};
  const std::string position = particles() + "/position", velocity = particles() + "/velocity";
  create_group(file, position);
  create_group(file, velocity);
  step_ = create_number_series(file, position + "/step", H5T_STD_I64LE);
  time_ = create_number_series(file, position + "/time", H5T_IEEE_F64LE);
  const hid_t type = mesh_.in_double ? H5T_IEEE_F64LE : H5T_IEEE_F32LE;
  position_ = create_series(file, position + "/value", type, frame, Packing::deflated);
  velocity_ = create_series(file, velocity + "/value", type, frame, Packing::deflated);
  link_step_and_time(file, position, velocity);

  const Hdf5Group observables = create_group(file, "/observables");
  if (const std::string_view work = energies_leave_out(system); !work.empty())
    write_attribute(observables.get(), "leaves_out", work);
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
  if (state.position.size() != mesh_.nodes || state.velocity.size() != mesh_.nodes)
    throw std::invalid_argument("a frame's state differs in size from the trace's system");
  if (!times_s_.empty() && !(step > last_step_ && time_s > times_s_.back()))
    throw std::invalid_argument("a trace's steps and times must increase");
  if (losses.has_value() != with_losses_)
    throw std::invalid_argument("a frame must have losses if and only if the trace's header says so");
  guard([&] { append(step, time_s, state, energy, losses.value_or(EnergyLosses{})); });
  last_step_ = step;
  times_s_.push_back(time_s);
}

void H5mdTrace::append(std::int64_t step, double time_s, const State& state, const Energy& energy,
                       const EnergyLosses& losses) {
  const hsize_t frame = times_s_.size();
  reserve_room(file_.get(), name(),
               2 * dimensions * mesh_.nodes * mesh_.bytes_per_number() + room_for_metadata);
  // HDF5 rounds them to single precision if the datasets hold it.
  write_row(position_, "positions", frame, H5T_NATIVE_DOUBLE, state.position.data());
  write_row(velocity_, "velocities", frame, H5T_NATIVE_DOUBLE, state.velocity.data());
  for (std::size_t kind = 0; kind < observables_.size(); ++kind) {
    const double value = observable_kinds[kind].value(energy, losses);
    write_row(observables_[kind], "energies", frame, H5T_NATIVE_DOUBLE, &value);
  }
  write_row(time_, "times", frame, H5T_NATIVE_DOUBLE, &time_s);
  write_row(step_, "steps", frame, H5T_NATIVE_INT64, &step);
  // A full disk only shows here, and only flushed data survives a kill.
  checked(H5Fflush(file_.get(), H5F_SCOPE_GLOBAL), "writing frame " + std::to_string(frame));
}

void H5mdTrace::close() {
  guard([&] {
    const std::string action = "finishing the trace";
    reserve_room(file_.get(), name(),
                 room_for_metadata + times_s_.size() * mesh_.parts.size() * xdmf_bytes_per_part_and_frame);
    map_frames_for_xdmf(file_.get(), mesh_, times_s_.size());
    checked(H5Fflush(file_.get(), H5F_SCOPE_GLOBAL), action);
    for (Hdf5Dataset* dataset : {&step_, &time_, &position_, &velocity_}) dataset->close(action);
    for (Hdf5Dataset& observable : observables_) observable.close(action);
    file_.close(action);
    release_reserved_space(temporary_of(name()));
    output_.move_into_place();
  });
  write_xdmf(name(), mesh_, times_s_);
}

void H5mdTrace::guard(const std::function<void()>& write) {
  const auto explain = [&](const std::string& message) {
    const std::size_t kept = give_up();
    if (kept == 0 && !times_s_.empty()) return message + "; the frames written before could not be saved";
    return message + kept_in_part(name(), "frames", kept);
  };
  prepare_hdf5();  // a different thread may write the frames
  try {
    write();
  } catch (const Hdf5Error& error) {
    throw WriteError(explain(write_failure(name(), error.action, error.error_number, error.what())));
  } catch (const WriteError& error) {
    throw WriteError(explain(error.what()));
  }
}

/// Closes everything without reporting errors. Frames that cannot be read do not count.
std::size_t H5mdTrace::give_up() {
  if (!output_.is_under_way()) return 0;
  for (Hdf5Dataset* dataset : {&step_, &time_, &position_, &velocity_}) *dataset = {};
  observables_.clear();
  file_ = {};
  const std::filesystem::path temporary = temporary_of(name());
  release_reserved_space(temporary);
  const std::size_t kept = times_s_.empty() ? 0 : std::min(times_s_.size(), count_frames(temporary));
  if (kept > 0)
    output_.keep();
  else
    output_.remove();
  return kept;
}

}  // namespace mssim
