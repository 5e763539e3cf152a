#include "bench/verification/reference_cache.h"

#include <algorithm>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <variant>
#include <vector>

#include "platform/files.h"
#include "platform/machine.h"
#include "text/text.h"

namespace mssim {
namespace {

namespace fs = std::filesystem;

/// Hash of everything that a reference of a cloth or bodies depends on.
std::uint64_t hash_of(const System& system) {
  // Names all members, so that a new one cannot be forgotten.
  const auto& [topology, springs, materials, pins, masses, gravity, viscous_damping, floor, solver, start] =
      system;
  std::string numbers =
      fmt::format("{} {} {} {} {} {} {} {} {} {} {} {}", springs.size(), materials.size(), pins.size(),
                  masses.size(), gravity, viscous_damping, floor.height, floor.restitution, floor.friction,
                  solver.tolerance, solver.iterations, solver.substeps);
  if (const auto* grid = std::get_if<GridPatch>(&topology))
    numbers += fmt::format(" grid {} {} {} {}", grid->rows, grid->columns, grid->spacing, grid->first_column);
  std::uint64_t hash = fnv1a_64(numbers);
  for (const std::string_view bytes : {bytes_of(springs), bytes_of(materials), bytes_of(pins),
                                       bytes_of(masses), bytes_of(start.position), bytes_of(start.velocity)})
    hash = fnv1a_64(bytes, hash);
  if (const auto* mesh = std::get_if<TetrahedralMesh>(&topology))
    hash = fnv1a_64(bytes_of(mesh->tetrahedra), hash);
  return hash;
}

/// Content of an entry between its head and the positions and velocities.
struct Numbers {
  std::int64_t steps;
  double step_seconds;
};

/// Reads the reference of an entry; none if the file is missing, damaged or another one's.
std::optional<Reference> read_entry(const fs::path& file, const std::string& head, const System& system) {
  const std::size_t vectors = system.nodes() * sizeof(Vec3d);
  const std::size_t size = head.size() + sizeof(Numbers) + 2 * vectors + sizeof(std::uint64_t);
  try {
    const std::string text = read_file(file, size);
    const std::size_t hashed = size - sizeof(std::uint64_t);
    if (text.size() != size || !text.starts_with(head) ||
        text.substr(hashed) != bytes_of(fnv1a_64(std::string_view(text).substr(0, hashed))))
      return std::nullopt;
    Numbers numbers{};
    Reference reference;
    reference.state.position.resize(system.nodes());
    reference.state.velocity.resize(system.nodes());
    const char* from = text.data() + head.size();
    std::memcpy(&numbers, from, sizeof numbers);
    std::memcpy(reference.state.position.data(), from += sizeof numbers, vectors);
    std::memcpy(reference.state.velocity.data(), from + vectors, vectors);
    reference.steps = static_cast<int>(numbers.steps);
    reference.step_seconds = numbers.step_seconds;
    return reference;
  } catch (const ReadError&) {
    return std::nullopt;
  }
}

void forget_oldest(const ReferenceCache& cache) {
  /// A file at the time when the folder was read; other processes may use and remove entries meanwhile.
  struct Entry {
    fs::path file;
    fs::file_time_type used;
    std::uint64_t bytes;
  };
  std::vector<Entry> entries;
  std::uint64_t bytes = 0;
  std::error_code end_of_list;
  for (fs::directory_iterator at(cache.folder, end_of_list), end; !end_of_list && at != end;
       at.increment(end_of_list)) {
    std::error_code gone, unknown;
    const std::uint64_t size = at->file_size(gone);
    const fs::file_time_type used = at->last_write_time(unknown);
    if (gone || unknown) continue;
    entries.push_back({at->path(), used, size});
    bytes += size;
  }
  std::ranges::sort(entries, {}, &Entry::used);
  for (const Entry& entry : entries) {
    if (bytes <= cache.most_bytes) return;
    bytes -= entry.bytes;
    std::error_code ignored;
    fs::remove(entry.file, ignored);
  }
}

void keep(const ReferenceCache& cache, const fs::path& file, const std::string& head,
          const Reference& reference) {
  try {
    make_folder(cache.folder);
    AtomicFile entry(file);
    const Numbers numbers{reference.steps, reference.step_seconds};
    std::uint64_t hash = fnv1a_64("");
    for (const std::string_view part :
         {std::string_view(head), bytes_of(numbers), bytes_of(reference.state.position),
          bytes_of(reference.state.velocity)}) {
      entry.append(part);
      hash = fnv1a_64(part, hash);
    }
    entry.append(bytes_of(hash));
    entry.move_into_place();
    forget_oldest(cache);
  } catch (const WriteError&) {
    // The reference is computed again next time, or another process is keeping the same one.
  }
}

}  // namespace

Reference recall_reference(const ReferenceCache& cache, const System& system, const Integrator& integrator,
                           double dt_s, bool anew) {
  if (cache.folder.empty() || 2 * system.nodes() * sizeof(Vec3d) > cache.most_bytes / 4)
    return run_reference(system, integrator, dt_s);
  const std::string head = fmt::format("mssim reference 1 {} {} {} {} {}\n", to_hex(cache.program_fnv1a_64),
                                       to_hex(hash_of(system)), integrator.name, dt_s, verification_steps);
  const fs::path file = cache.folder / to_hex(fnv1a_64(head));
  if (std::optional<Reference> found = anew ? std::nullopt : read_entry(file, head, system)) {
    std::error_code ignored;
    fs::last_write_time(file, fs::file_time_type::clock::now(), ignored);
    found->energy = energy_of(system, found->state);
    found->integrator = &integrator;
    found->tolerance = position_tolerance(system, integrator, found->steps);
    found->recalled = true;
    return *std::move(found);
  }
  const Stopwatch watch;
  Reference reference = run_reference(system, integrator, dt_s);
  if (!reference.failure && watch.seconds() >= cache.least_seconds) keep(cache, file, head, reference);
  return reference;
}

}  // namespace mssim
