#include "backends/opencl/mesh.h"

#include <CL/opencl.hpp>
#include <cstdint>
#include <span>
#include <vector>

#include "backends/devices/work_items.h"
#include "backends/layouts/node_records.h"
#include "backends/layouts/sliced_graph.h"
#include "backends/opencl/mesh_program.h"
#include "backends/opencl/stages.h"

namespace mssim {
namespace {

PairLayout record_layout(const SlicedGraph& graph) {
  PairLayout pair;
  pair.floats = record_floats * graph.slots();
  pair.component = {0, 1, 2, 4, 5, 6};
  for (const std::uint32_t slot : graph.slot) pair.node.push_back(record_floats * slot);
  return pair;
}

class OpenclMesh final : public OpenclStages {
 public:
  OpenclMesh(const System& system, const Integrator& integrator, double dt_s, const OpenclDevice& device,
             DeviceMemory memory, int lanes, const SlicedGraph& graph)
      : OpenclStages(system, integrator, dt_s, device, memory, record_layout(graph),
                     {graph.neighbour.size() * sizeof(cl_uint), graph.neighbour.size() * sizeof(float)}) {
    const std::size_t tiles = graph.slots() / static_cast<std::size_t>(lanes);
    const OpenclChunks chunks(tiles, device, lanes);
    const MeshParameters parameters{static_cast<cl_uint>(tiles), static_cast<cl_uint>(chunks.per_item)};
    add_argument(std::span(&parameters, 1));
    add_argument(std::span(graph.first_entry));
    add_argument(std::span(graph.neighbour));
    add_argument(std::span(graph.stiffness_rest));
    add_argument(std::span(graph.stiffness));
    add_argument(std::span(graph.damping));
    add_argument(std::span(graph.held));
    prepare(mesh_program_text(integrator, lanes), chunks.items, system.start);
  }
};

}  // namespace

std::unique_ptr<Backend> make_opencl_mesh(const System& system, const Integrator& integrator, double dt_s,
                                          const OpenclDevice& device, DeviceMemory memory, int lanes) {
  const SlicedGraph graph(system, mesh_slice_lanes(lanes));
  return std::make_unique<OpenclMesh>(system, integrator, dt_s, device, memory, lanes, graph);
}

}  // namespace mssim
