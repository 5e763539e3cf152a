#include "backends/opencl_mesh.h"

#include <CL/opencl.hpp>
#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "backends/opencl_mesh_program.h"
#include "backends/opencl_stages.h"
#include "backends/sliced_graph/sliced_graph.h"
#include "kernels/mesh_parameters.h"

namespace mssim {
namespace {

/// Records of eight floats (kernels/records.h).
PairLayout record_layout(const SlicedGraph& graph) {
  constexpr std::size_t record_floats = 8;
  PairLayout pair{.floats = record_floats * graph.places(), .node = {}, .component = {0, 1, 2, 4, 5, 6}};
  for (const std::uint32_t place : graph.place) pair.node.push_back(record_floats * place);
  return pair;
}

/// For a CPU few work-items, each taking many sites in turn, and yet enough that one that was held up leaves
/// some of its share to the others; else one per node, in groups as wide as any hardware's.
struct Launch {
  MeshParameters parameters{};
  std::size_t global = 0, local = 0;

  Launch(const SlicedGraph& graph, const OpenclDevice& device, int lanes) {
    constexpr std::size_t good_items_per_unit = 4, good_group = 64;
    const bool wide = lanes > 1;
    const std::size_t sites = graph.places() / static_cast<std::size_t>(lanes);
    const std::size_t per_item =
        wide ? std::max<std::size_t>(1, sites / (good_items_per_unit * device.compute_units)) : 1;
    const std::size_t items = (sites + per_item - 1) / per_item;
    parameters.sites = static_cast<cl_uint>(sites);
    parameters.sites_per_item = static_cast<cl_uint>(per_item);
    local = wide ? 1 : good_group;
    global = (items + local - 1) / local * local;
  }
};

class OpenclMesh final : public OpenclStages {
 public:
  OpenclMesh(const System& system, const Integrator& integrator, double dt_s, const OpenclDevice& device,
             int lanes, const SlicedGraph& graph)
      : OpenclStages(system, integrator, dt_s, device, record_layout(graph),
                     {graph.neighbour.size() * sizeof(cl_uint), graph.neighbour.size() * sizeof(float)}) {
    const Launch launch(graph, device, lanes);
    add_argument(std::span(&launch.parameters, 1));
    add_argument(std::span(graph.first_entry));
    add_argument(std::span(graph.neighbour));
    add_argument(std::span(graph.stiffness_rest));
    add_argument(std::span(graph.stiffness));
    add_argument(std::span(graph.damping));
    add_argument(std::span(graph.held));
    prepare(mesh_program_text(integrator, lanes), {cl::NDRange(launch.global), cl::NDRange(launch.local)},
            system.start);
  }
};

}  // namespace

std::unique_ptr<Backend> make_opencl_mesh(const System& system, const Integrator& integrator, double dt_s,
                                          const OpenclDevice& device, int lanes) {
  const SlicedGraph graph(system, mesh_slice_lanes(lanes));
  return std::make_unique<OpenclMesh>(system, integrator, dt_s, device, lanes, graph);
}

}  // namespace mssim
