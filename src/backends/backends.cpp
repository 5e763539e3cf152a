#include "backends/backends.h"

#include <algorithm>
#include <array>
#include <vector>

#include "backends/devices/device.h"
#include "backends/devices/drivers.h"
#include "backends/hybrid/hybrid.h"
#include "backends/implicit/implicit.h"
#include "backends/opencl/opencl.h"
#include "backends/openmp/openmp.h"
#include "backends/spring_list/list_backends.h"
#include "garment/stepping/published_dressing.h"
#include "platform/machine.h"
#include "text/text.h"

namespace mssim {
namespace {

// Memory per node and spring. On a cloth, padding of bands and planes is negligible; bodies are cut into
// slices, whose construction takes about as much memory again. Backends with a device read a state back into
// growing arrays, which takes about 40 bytes per node besides the state. tests/bench/bench_memory_test.cpp
// compares these numbers with the memory actually used.
constexpr MemoryUse bands{.node = 24};  // all pairs except the state are a few columns
constexpr MemoryUse slices{.node = 130, .pair_node = 32, .storage = Storage::separate, .spring = 38};
constexpr MemoryUse planes{.node = 56, .pair_node = 24, .storage = Storage::separate};
constexpr MemoryUse device_slices{.node = 130, .pair_node = 32, .storage = Storage::separate, .spring = 38};
constexpr MemoryUse packed{.node = 64, .pair_node = 32, .spring = 50};
// A program's own memory is unknown: assume a plain list in double precision and the state's file.
constexpr MemoryUse own_program{.node = 64, .pair_node = 24, .spring = 40};

std::unique_ptr<DressingBackend> dress_by_opencl(const System& system, const Integrator& integrator,
                                                 double dt_s, const ExecutionOptions& options) {
  const OpenclDevice device = device_for(options);
  try_driver({"opencl", std::string(integrator.name), SteppedKind::garment, options}, device);
  return make_opencl_dressing(system, integrator, dt_s, device, options.memory,
                              DressingShape::of(device, lanes_for(device)));
}

/// Of the same layout in double precision: twice as much, or a little less where there are indices.
constexpr MemoryUse doubled(MemoryUse single) {
  single.node *= 2;
  single.pair_node *= 2;
  single.spring *= 2;
  return single;
}

constexpr auto table = std::to_array<BackendInfo>({
    {.name = "serial",
     .paper_configuration = "cpu-only",
     .description = "one thread, spring list: the baseline, and in double precision the reference",
     .make = make_serial,
     .grid_memory = spring_list_memory,
     .mesh_memory = spring_list_memory,
     .role = BackendRole::baseline,
     .make_dressing = make_serial_dressing,
     .make_implicit = make_serial_implicit,
     .implicit_memory = serial_implicit_memory,
     .make_in_double = make_serial_in_double,
     .collides_layers = true},
    {.name = "threads-mutex",
     .paper_configuration = "multi-thread-cpu",
     .description = "as published: spring groups per thread, a lock around the accumulation",
     .makes_threads = true,
     .make = make_threads_mutex,
     .grid_memory = spring_list_memory,
     .mesh_memory = spring_list_memory,
     .step_share = 1.2},
    {.name = "openmp",
     .paper_configuration = "multi-thread-cpu",
     .description = "vectorised and race-free: the same bits at every thread count",
     .makes_threads = true,
     .make = make_openmp,
     .grid_memory = bands,
     .mesh_memory = slices,
     .step_share = 0.06,
     .role = BackendRole::best_of_host,
     .make_dressing = make_openmp_dressing,
     .make_implicit = make_openmp_implicit,
     .implicit_memory = openmp_implicit_memory,
     .has_vectors = true,
     .make_in_double = make_openmp_in_double,
     .collides_layers = true},
    {.name = "opencl",
     .paper_configuration = "gpu",
     .description = "fused stage kernels on an OpenCL device",
     .uses_device = true,
     .make = make_opencl,
     .grid_memory = planes,
     .mesh_memory = device_slices,
     .step_share = 0.12,
     .role = BackendRole::contender,
     .make_dressing = dress_by_opencl},
    {.name = "hybrid",
     .paper_configuration = "gpu+multi-thread-cpu",
     .description = "OpenCL computes spring forces into shared memory, OpenMP sums and integrates",
     .uses_device = true,
     .makes_threads = true,
     .make = make_hybrid,
     .grid_memory = packed,
     .mesh_memory = packed,
     .step_share = 0.35},
});

constexpr const BackendInfo& only_row(BackendRole role) {
  return *std::ranges::find(table, role, &BackendInfo::role);
}
static_assert(std::ranges::count(table, BackendRole::baseline, &BackendInfo::role) == 1 &&
              std::ranges::count(table, BackendRole::best_of_host, &BackendInfo::role) == 1);

/// Throws Unavailable if the system cannot create the threads that the backend would create, or if the row
/// fixes more threads than make sense on this machine (thread_excess).
void require_threads(const BackendInfo& backend, const ExecutionOptions& options) {
  if (backend.threads > 0)
    if (const auto excess = thread_excess(backend.threads))
      throw Unavailable(fmt::format("{} are {}", pluralize(backend.threads, "thread"), *excess));
  if (!backend.makes_threads) return;
  if (const auto shortage = thread_shortage(options.threads)) throw Unavailable(*shortage);
}

}  // namespace

std::span<const BackendInfo> backends() { return table; }

std::string names_of(bool (*has)(const BackendInfo& row), std::string_view last) {
  std::vector<std::string_view> names;
  for (const std::span<const BackendInfo> rows : {backends(), garment_backends()})
    for (const BackendInfo& row : rows)
      if (has(row)) names.push_back(row.name);
  return listed(names, last);
}

std::vector<std::string_view> instruction_sets() { return openmp_instruction_sets(); }

const BackendInfo& baseline_backend() { return only_row(BackendRole::baseline); }

const BackendInfo& best_host_backend() { return only_row(BackendRole::best_of_host); }

std::span<const BackendInfo> garment_backends() {
  static const std::vector<BackendInfo> rows = [] {
    // Springs and joints are kept in an order of their own, beside nodes of three vectors and two masses.
    constexpr MemoryUse loops{.node = 72, .spring = 28};
    std::vector<BackendInfo> of_garments;
    for (const PublishedDressing& dressing : published_dressings)
      of_garments.push_back({.name = dressing.name,
                             .description = dressing.description,
                             .makes_threads = dressing.parallel,
                             .grid_memory = loops,
                             .mesh_memory = loops,
                             .make_dressing = maker_of(dressing),
                             .make_dressing_reference = make_published_reference});
    return of_garments;
  }();
  return rows;
}

const BackendInfo* find_backend(std::string_view name) {
  for (const std::span<const BackendInfo> rows : {backends(), garment_backends()})
    if (const BackendInfo* row = found_in(rows, name, &BackendInfo::name)) return row;
  return nullptr;
}

BackendInfo own_backend(const BackendProgram& program) {
  return {.name = program.name,
          .description = program.description,
          .grid_memory = own_program,
          .mesh_memory = own_program,
          .program = &program};
}

MemoryUse memory_of(const BackendInfo& backend, const Integrator& integrator, bool grid) {
  if (is_implicit(integrator))
    return backend.implicit_memory == nullptr ? MemoryUse{} : backend.implicit_memory(integrator, grid);
  const MemoryUse& single = grid ? backend.grid_memory : backend.mesh_memory;
  return backend.in_double ? doubled(single) : single;
}

std::string unsupported_reason(const BackendInfo& backend, const Integrator& integrator) {
  if (backend.program != nullptr) return unsupported_reason(*backend.program, integrator);
  if (backend.make == nullptr) return "it steps garments only";
  if (backend.in_double && is_implicit(integrator))
    return "in double precision it steps explicit integrators only";
  if (!is_implicit(integrator) || backend.make_implicit != nullptr) return {};
  return "implicit integrators are stepped by " +
         names_of([](const BackendInfo& row) { return row.make_implicit != nullptr; });
}

std::string unsupported_reason(const BackendInfo& backend, const Garment& garment) {
  if (!dresses(backend)) return "garments are dressed by " + names_of(dresses);
  if (!garment.touching || backend.collides_layers) return {};
  return "garments whose layers touch each other are dressed by " +
         names_of([](const BackendInfo& row) { return row.collides_layers; });
}

std::unique_ptr<Backend> make_backend(const BackendInfo& backend, const System& system,
                                      const Integrator& integrator, double dt_s,
                                      const ExecutionOptions& asked) {
  if (backend.each_body) {
    BackendInfo of_one = backend;
    of_one.each_body = false;
    return make_for_each_body(
        system, [&](const System& body) { return make_backend(of_one, body, integrator, dt_s, asked); });
  }
  if (is_garment(system)) return make_dressing_backend(backend, system, integrator, dt_s, asked);
  const ExecutionOptions options = execution_of(backend, asked);
  if (backend.program != nullptr)
    return make_process_backend(*backend.program, system, integrator, dt_s, options);
  if (const std::string reason = unsupported_reason(backend, integrator); !reason.empty())
    throw Unsupported(reason);
  require_threads(backend, options);
  if (is_implicit(integrator)) return backend.make_implicit(system, integrator, dt_s, options);
  const auto make = backend.in_double ? backend.make_in_double : backend.make;
  return step_ahead(make(system, integrator, dt_s, options), system, integrator, dt_s);
}

std::unique_ptr<Backend> make_window_backend(const BackendInfo& backend, const System& outline,
                                             const Integrator& integrator, double dt_s,
                                             const ExecutionOptions& options,
                                             const std::vector<GridWindow>& windows) {
  if (!has_windows(backend)) throw Unsupported("it needs the whole cloth");
  return make_process_backend(*backend.program, outline, integrator, dt_s, options, windows);
}

std::unique_ptr<DressingBackend> make_dressing_backend(const BackendInfo& backend, const System& system,
                                                       const Integrator& integrator, double dt_s,
                                                       const ExecutionOptions& asked) {
  const std::string reason = unsupported_reason(backend, std::get<Garment>(system.topology));
  if (!reason.empty()) throw Unsupported(reason);
  const ExecutionOptions options = execution_of(backend, asked);
  require_threads(backend, options);
  return backend.make_dressing(system, integrator, dt_s, options);
}

std::string unavailable_reason(const BackendInfo& backend, const ExecutionOptions& options) {
  if (backend.program != nullptr) return backend.program->missing;
  try {
    if (backend.uses_device) find_opencl_device(options.device);
    require_threads(backend, execution_of(backend, options));
  } catch (const Unavailable& reason) {
    return reason.what();
  }
  return "";
}

std::string excess_of(const BackendInfo& info, const Backend& backend, const ExecutionOptions& options) {
  const ExecutionOptions its = execution_of(info, options);
  const int asked = info.program ? processors_of(*info.program, its) : its.threads;
  if (backend.threads() <= asked) return "";
  return fmt::format("on {} processors instead of {}: {}", backend.threads(), asked,
                     backend.reason_for_excess());
}

std::unique_ptr<Backend> make_reference(const System& system, const Integrator& integrator, double dt_s,
                                        const std::function<bool()>& stop) {
  if (is_implicit(integrator)) return make_implicit_reference(system, integrator, dt_s, stop);
  return step_ahead(make_serial_in_double(system, integrator, dt_s, {}), system, integrator, dt_s);
}

MemoryUse reference_memory(const Integrator& integrator, bool grid) {
  if (is_implicit(integrator)) return implicit_reference_memory(integrator, grid);
  return doubled(spring_list_memory);
}

}  // namespace mssim
