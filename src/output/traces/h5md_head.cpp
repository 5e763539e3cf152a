#include "output/traces/h5md_head.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "garment/output/h5md_garment.h"
#include "hdf5/hdf5.h"
#include "hdf5/hdf5_table.h"
#include "output/traces/xdmf.h"

namespace mssim {
namespace {

struct UnitInfo {
  const char* quantity;
  const char* unit;
};
/// In the notation of H5MD's units module. They stand apart, under /parameters/units, because MDAnalysis
/// refuses a `unit` attribute that is a fixed-length string and knows no metres; without any it must be told
/// convert_units=False.
constexpr std::array<UnitInfo, 8> units{{
    {"position", "m"},
    {"velocity", "m s-1"},
    {"time", "s"},
    {"mass", "kg"},
    {"energy", "J"},
    {"rest_length", "m"},
    {"stiffness", "N m-1"},
    {"damping", "N s m-1"},
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

void write_parameters(hid_t file, const Topology& topology, const TraceHeader& header) {
  const Hdf5Group parameters = create_group(file, "/parameters");
  write_text(file, "/parameters/scene", header.scene_json);
  write_text(file, "/parameters/provenance", header.provenance_json);
  write_attribute(parameters.get(), "backend", std::string_view(header.backend));
  write_attribute(parameters.get(), "integrator", std::string_view(header.integrator));
  write_attribute(parameters.get(), "dt_s", header.dt_s);
  if (const auto* grid = std::get_if<GridPatch>(&topology)) {
    write_attribute(parameters.get(), "rows", std::int64_t{grid->rows});
    write_attribute(parameters.get(), "columns", std::int64_t{grid->columns});
  }
  if (const auto* garment = std::get_if<Garment>(&topology)) write_garment(file, *garment);
  const Hdf5Group units_group = create_group(file, "/parameters/units");
  for (const auto& [quantity, unit] : units)
    write_attribute(units_group.get(), quantity, std::string_view(unit));
}

void create_particles(hid_t file, const std::string& particles) {
  create_group(file, "/particles");
  create_group(file, particles);
  const Hdf5Group box = create_group(file, particles + "/box");
  constexpr std::array<std::string_view, 3> boundary{"none", "none", "none"};
  write_attribute(box.get(), "dimension", std::int64_t{boundary.size()});
  write_attribute(box.get(), "boundary", boundary);
}

void write_mass(hid_t file, const std::string& particles, const System& system) {
  write_numbers(file, particles + "/mass", system.node_mass);
}

/// What a strain or a force is computed from, in the order of /connectivity/springs.
void write_springs(hid_t file, const System& system) {
  if (system.springs.empty()) return;
  const auto write = [&](const std::string& name, const auto& number_of) {
    std::vector<double> numbers;
    numbers.reserve(system.springs.size());
    for (const Spring& spring : system.springs)
      numbers.push_back(number_of(spring, system.materials[spring.kind]));
    write_numbers(file, "/parameters/springs/" + name, numbers);
  };
  create_group(file, "/parameters/springs");
  write("rest_length",
        [](const Spring& spring, const SpringMaterial&) { return double{spring.rest_length}; });
  write("stiffness", [](const Spring&, const SpringMaterial& material) { return material.stiffness; });
  write("damping", [](const Spring&, const SpringMaterial& material) { return material.damping; });
}

void write_connectivity(hid_t file, const std::string& particles, const System& system) {
  const Hdf5Group connectivity = create_group(file, "/connectivity");
  std::vector<std::array<std::uint32_t, 2>> ends;
  ends.reserve(system.springs.size());
  for (const Spring& spring : system.springs) ends.push_back({spring.first, spring.second});
  write_tuples<2>(file, "/connectivity/springs", particles, ends);
  if (const auto* mesh = std::get_if<TetrahedralMesh>(&system.topology))
    write_tuples<4>(file, tetrahedra_dataset, particles, mesh->tetrahedra);
  if (const auto* garment = std::get_if<Garment>(&system.topology)) write_joints(file, particles, *garment);
}

}  // namespace

void require_fitting_topology(const Topology& topology, std::size_t nodes) {
  if (nodes == 0) throw std::invalid_argument("a trace needs nodes");
  if (const auto* grid = std::get_if<GridPatch>(&topology)) {
    if (std::uint64_t{grid->rows} * grid->columns != nodes)
      throw std::invalid_argument("a trace needs a grid of all nodes");
    return;
  }
  if (const auto* garment = std::get_if<Garment>(&topology)) return require_fitting_garment(*garment, nodes);
  const auto& tetrahedra = std::get<TetrahedralMesh>(topology).tetrahedra;
  const bool fits = std::ranges::all_of(tetrahedra, [&](const Tetrahedron& corners) {
    return std::ranges::all_of(corners, [&](std::uint32_t corner) { return corner < nodes; });
  });
  if (tetrahedra.empty() || !fits)
    throw std::invalid_argument("a trace of bodies needs tetrahedra between its nodes");
}

void write_h5md_head(hid_t file, const std::string& particles, const System& system,
                     const TraceHeader& header) {
  write_metadata(file, header);
  write_parameters(file, system.topology, header);
  create_particles(file, particles);
  write_mass(file, particles, system);
  write_connectivity(file, particles, system);
  write_springs(file, system);
}

}  // namespace mssim
