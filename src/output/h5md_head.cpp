#include "output/h5md_head.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "output/hdf5_write.h"
#include "output/xdmf.h"

namespace mssim {
namespace {

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
  const std::array<hsize_t, 1> shape{system.nodes()};
  Hdf5Dataset mass = create_dataset(file, particles + "/mass", H5T_IEEE_F64LE, shape, false,
                                    chunked(shape, Packing::deflated));
  checked(H5Dwrite(mass.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, system.node_mass.data()),
          "writing masses");
  mass.close("writing masses");
}

/// Tuples of nodes: an empty list has no dataset.
template <std::size_t size>
void write_tuples(hid_t file, const std::string& path, const std::string& particles,
                  std::span<const std::array<std::uint32_t, size>> tuples) {
  if (tuples.empty()) return;
  const std::string action = "writing " + path;
  constexpr hsize_t tuples_per_chunk = 65536;
  const std::array<hsize_t, 2> shape{tuples.size(), size};
  const std::array<hsize_t, 2> chunk{std::min(shape[0], tuples_per_chunk), size};
  const Hdf5Properties properties = chunked(chunk, Packing::deflated);
  // Readers of H5MD pass over tuples that hold the fill value. HDF5's own is 0, a real node.
  constexpr std::uint32_t no_node = std::numeric_limits<std::uint32_t>::max();
  checked(H5Pset_fill_value(properties.get(), H5T_NATIVE_UINT32, &no_node), "setting a fill value");
  Hdf5Dataset dataset = create_dataset(file, path, H5T_STD_U32LE, shape, false, properties);
  checked(H5Dwrite(dataset.get(), H5T_NATIVE_UINT32, H5S_ALL, H5S_ALL, H5P_DEFAULT, tuples.data()), action);
  write_reference(dataset.get(), "particles_group", file, particles);
  dataset.close(action);
}

void write_connectivity(hid_t file, const std::string& particles, const System& system) {
  const Hdf5Group connectivity = create_group(file, "/connectivity");
  std::vector<std::array<std::uint32_t, 2>> ends;
  ends.reserve(system.springs.size());
  for (const Spring& spring : system.springs) ends.push_back({spring.first, spring.second});
  write_tuples<2>(file, "/connectivity/springs", particles, ends);
  if (const auto* mesh = std::get_if<TetrahedralMesh>(&system.topology))
    write_tuples<4>(file, tetrahedra_dataset, particles, mesh->tetrahedra);
}

}  // namespace

void require_fitting_topology(const System& system) {
  const std::size_t nodes = system.nodes();
  if (nodes == 0) throw std::invalid_argument("a trace needs a system with nodes");
  if (const auto* grid = std::get_if<GridPatch>(&system.topology)) {
    if (grid->nodes() != nodes) throw std::invalid_argument("a trace needs a grid of all nodes");
    return;
  }
  const auto& tetrahedra = std::get<TetrahedralMesh>(system.topology).tetrahedra;
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
}

}  // namespace mssim
