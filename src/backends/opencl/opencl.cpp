#include "backends/opencl/opencl.h"

#include <bit>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "backends/devices/drivers.h"
#include "backends/layouts/alike_bodies.h"
#include "backends/layouts/node_arrays.h"
#include "backends/layouts/sliced_graph.h"
#include "backends/opencl/cloth.h"
#include "backends/opencl/programs.h"
#include "backends/opencl/stages.h"
#include "kernels/parameters.h"

namespace mssim {
namespace {

PairLayout record_layout(const SlicedGraph& graph) {
  PairLayout pair;
  pair.floats = record_floats * graph.slots();
  pair.component = {0, 1, 2, 4, 5, 6};
  for (const std::uint32_t slot : graph.slot) pair.node.push_back(record_floats * slot);
  return pair;
}

/// Bodies, from their sliced graph, which holds one material of springs a node.
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

/// The bodies as the kernels see them (kernels/alike_stage.cl).
struct AlikeGraph {
  struct Slice {
    cl_uint first_spring, end_spring, first_slice, pinned;
  };
  struct Neighbour {
    cl_uint node;  // of the body
    cl_uint stiffness_rest;
  };
  struct Constants {
    float stiffness, damping;
  };
  std::vector<Slice> slices;
  std::vector<Neighbour> springs;  // of a shape, from both ends, by node, ascending by neighbour
  std::vector<Constants> constants;
  std::uint64_t stored_springs = 0;

  AlikeGraph(const std::vector<AlikeBodies>& bodies, const AlikeSlices& layout);
};

std::vector<std::vector<AlikeGraph::Neighbour>> neighbours_of(const AlikeBodies& bodies) {
  std::vector<std::vector<AlikeGraph::Neighbour>> of_node(bodies.nodes());
  for (cl_uint node = 0; node < bodies.nodes(); ++node)
    for (cl_uint s = bodies.first_spring[node]; s < bodies.first_spring[node + 1]; ++s) {
      const AlikeBodies::SpringAhead& spring = bodies.springs[s];
      const auto bits = std::bit_cast<cl_uint>(spring.stiffness_rest);
      of_node[node].push_back({spring.other, bits});
      of_node[spring.other].push_back({node, bits});
    }
  return of_node;
}

AlikeGraph::AlikeGraph(const std::vector<AlikeBodies>& bodies, const AlikeSlices& layout) {
  std::vector<std::vector<Slice>> of_shape;  // but for the first slice
  for (const AlikeBodies& of : bodies) {
    stored_springs += of.springs.size();
    of_shape.emplace_back();
    for (const std::vector<Neighbour>& neighbours : neighbours_of(of)) {
      const auto first = static_cast<cl_uint>(springs.size());
      springs.insert(springs.end(), neighbours.begin(), neighbours.end());
      of_shape.back().push_back(
          {first, static_cast<cl_uint>(springs.size()), 0, of.pinned[of_shape.back().size()]});
    }
  }
  for (const AlikeSlices::Group& group : layout.groups)
    for (Slice slice : of_shape[group.shape]) {
      slice.first_slice = static_cast<cl_uint>(group.first_slice);
      slices.push_back(slice);
      constants.push_back({bodies[group.shape].stiffness, bodies[group.shape].damping});
    }
}

/// Throws Unsupported where the kernels' numbers do not suffice for tiles and springs.
void require_numbers(const std::vector<AlikeBodies>& bodies, std::size_t slots) {
  constexpr std::size_t most = std::numeric_limits<cl_uint>::max();
  std::size_t springs = 0;
  for (const AlikeBodies& of : bodies) springs += 2 * of.springs.size();
  if (slots > most || springs > most)
    throw Unsupported("the scene has " + std::to_string(slots) + " places of nodes and " +
                      std::to_string(springs) + " ends of springs; opencl supports at most " +
                      std::to_string(most) + " of each");
}

PairLayout slice_layout(const AlikeSlices& slices) {
  PairLayout pair;
  pair.floats = slices.floats();
  for (std::size_t i = 0; i < pair.component.size(); ++i) pair.component[i] = i * slices.lanes;
  pair.node.resize(slices.nodes, pair.floats);
  for (std::size_t slot = 0; slot < slices.scene_node.size(); ++slot) {
    const std::uint32_t node = slices.scene_node[slot];
    const std::size_t at = slot / slices.lanes * AlikeSlices::components * slices.lanes + slot % slices.lanes;
    if (pair.node[node] == pair.floats)
      pair.node[node] = at;
    else
      pair.copies.emplace_back(at, node);
  }
  return pair;
}

/// Alike bodies, `lanes` of them side by side, to the bits of OpenclMesh.
class OpenclAlikeMesh final : public OpenclStages {
 public:
  OpenclAlikeMesh(const System& system, const Integrator& integrator, double dt_s, const OpenclDevice& device,
                  DeviceMemory memory, int lanes, const AlikeSlices& slices, const AlikeGraph& graph)
      : OpenclStages(system, integrator, dt_s, device, memory, slice_layout(slices),
                     {graph.slices.size() * sizeof(AlikeGraph::Slice),
                      graph.springs.size() * sizeof(AlikeGraph::Neighbour)}),
        stored_springs_(graph.stored_springs) {
    const std::size_t tiles = slices.scene_node.size() / static_cast<std::size_t>(lanes);
    const OpenclChunks chunks(tiles, device, lanes);
    const MeshParameters parameters{static_cast<cl_uint>(tiles), static_cast<cl_uint>(chunks.per_item)};
    add_argument(std::span(&parameters, 1));
    add_argument(std::span(graph.slices));
    add_argument(std::span(graph.springs));
    add_argument(std::span(graph.constants));
    prepare(alike_program_text(integrator, lanes), chunks.items, system.start);
  }

  std::optional<std::uint64_t> stored_springs() const override { return stored_springs_; }

 private:
  std::uint64_t stored_springs_;
};

/// `before`: is told of what kind the system is before any program is compiled.
template <class Before>
std::unique_ptr<Backend> make(const System& system, const Integrator& integrator, double dt_s,
                              const OpenclDevice& device, int lanes, DeviceMemory memory,
                              const Before& before) {
  return opencl_call<Unavailable>([&]() -> std::unique_ptr<Backend> {
    if (const auto* grid = std::get_if<GridPatch>(&system.topology)) {
      before(SteppedKind::cloth);
      return make_opencl_grid(system, *grid, integrator, dt_s, device, memory, lanes);
    }
    // With thirteen bodies in sixteen lanes a step takes 0.61 of the time that a sliced graph takes (PoCL on
    // an Intel Xeon): so it is worth it from nine on.
    constexpr double lanes_per_body = 1.8;
    const auto alike = alike_bodies_for(system, alike_slice_lanes(lanes), lanes_per_body);
    before(alike ? SteppedKind::alike_bodies : SteppedKind::bodies);
    if (!alike)
      return std::make_unique<OpenclMesh>(system, integrator, dt_s, device, memory, lanes,
                                          SlicedGraph(system, mesh_slice_lanes(lanes)));
    const AlikeSlices slices(*alike, alike_slice_lanes(lanes));
    require_numbers(*alike, slices.scene_node.size());
    return std::make_unique<OpenclAlikeMesh>(system, integrator, dt_s, device, memory, lanes, slices,
                                             AlikeGraph(*alike, slices));
  });
}

}  // namespace

std::unique_ptr<Backend> make_opencl(const System& system, const Integrator& integrator, double dt_s,
                                     const OpenclDevice& device, int lanes, DeviceMemory memory) {
  return make(system, integrator, dt_s, device, lanes, memory, [](SteppedKind) {});
}

std::unique_ptr<Backend> make_opencl(const System& system, const Integrator& integrator, double dt_s,
                                     const ExecutionOptions& options) {
  const OpenclDevice device = device_for(options);
  return make(system, integrator, dt_s, device, lanes_for(device), options.memory, [&](SteppedKind kind) {
    try_driver({"opencl", std::string(integrator.name), kind, options}, device);
  });
}

}  // namespace mssim
