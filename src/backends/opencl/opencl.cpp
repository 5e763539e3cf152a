#include "backends/opencl/opencl.h"

#include <bit>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

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
  PairLayout pair(record_floats * graph.slots(), 1);
  pair.to_velocity = record_floats / 2;
  for (const std::uint32_t slot : graph.slot) pair.node.push_back(record_floats * slot);
  return pair;
}

/// [slices][spring_constant_count][lanes] constants of the nodes.
std::vector<float> slice_constants(const SlicedGraph& graph) {
  std::vector<float> constants(graph.slots() * spring_constant_count);
  for (std::size_t slot = 0; slot < graph.slots(); ++slot)
    write_constants(constants.data() + slot_offset(slot, spring_constant_count, graph.lanes), graph.lanes,
                    graph.constants[slot]);
  return constants;
}

/// How work-items share the nodes of bodies, with `lanes` nodes per tile.
struct MeshTiles {
  OpenclChunks chunks;
  MeshParameters parameters;

  MeshTiles(std::size_t slots, const OpenclDevice& device, int lanes)
      : chunks(slots / static_cast<std::size_t>(lanes), device, lanes),
        parameters{static_cast<cl_uint>(slots / static_cast<std::size_t>(lanes)),
                   static_cast<cl_uint>(chunks.per_item)} {}
};

/// The bodies in the layout of the kernels (kernels/alike_stage.cl).
struct AlikeGraph {
  struct Slice {
    cl_uint first_spring, end_spring, first_slice, pinned;
  };
  struct Neighbour {
    cl_uint node;  // in the body
    cl_uint stiffness_rest;
  };
  std::vector<Slice> slices;
  std::vector<Neighbour> springs;  // of a shape, seen from both ends, by node, ascending by neighbour
  std::vector<SpringConstants<float>> constants;  // [slices]
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
  std::vector<std::vector<Slice>> of_shape;  // [shapes] without the first slice
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
      constants.push_back(bodies[group.shape].constants);
    }
}

/// Throws Unsupported if the kernels' integers are too small for the tiles and springs.
void require_numbers(const std::vector<AlikeBodies>& bodies, std::size_t slots) {
  constexpr std::size_t most = std::numeric_limits<cl_uint>::max();
  std::size_t springs = 0;
  for (const AlikeBodies& of : bodies) springs += 2 * of.springs.size();
  if (slots > most || springs > most)
    throw Unsupported(
        "the scene has {} places of nodes and {} ends of springs; opencl supports at most {} of each", slots,
        springs, most);
}

PairLayout slice_layout(const AlikeSlices& slices) {
  PairLayout pair(slices.floats(), slices.lanes);
  pair.node.resize(slices.nodes, pair.floats);
  for (std::size_t slot = 0; slot < slices.scene_node.size(); ++slot) {
    const std::uint32_t node = slices.scene_node[slot];
    const std::size_t at = slot_offset(slot, AlikeSlices::components, slices.lanes);
    if (pair.node[node] == pair.floats)
      pair.node[node] = at;
    else
      pair.copies.emplace_back(at, node);
  }
  return pair;
}

}  // namespace

std::unique_ptr<Backend> make_opencl(const System& system, const Integrator& integrator, double dt_s,
                                     const OpenclDevice& device, int lanes, DeviceMemory memory,
                                     const std::function<void(SteppedKind)>& before) {
  return opencl_call<Unavailable>([&]() -> std::unique_ptr<Backend> {
    if (const auto* grid = std::get_if<GridPatch>(&system.topology)) {
      before(SteppedKind::cloth);
      return make_opencl_grid(system, *grid, integrator, dt_s, device, memory, lanes);
    }
    // With thirteen bodies in sixteen lanes a step takes 0.61 of the time of a sliced graph (PoCL on an Intel
    // Xeon), so it pays off from nine bodies on.
    constexpr double lanes_per_body = 1.8;
    const auto alike = alike_bodies_for(system, alike_slice_lanes(lanes), lanes_per_body);
    before(alike ? SteppedKind::alike_bodies : SteppedKind::bodies);
    const auto stages = [&](const StageKernels& kernels) {
      return std::make_unique<OpenclStages>(system, integrator, dt_s, device, memory, kernels);
    };
    if (!alike) {
      const SlicedGraph graph(system, mesh_slice_lanes(lanes));
      const std::vector<float> constants = slice_constants(graph);
      const MeshTiles tiles(graph.slots(), device, lanes);
      return stages({record_layout(graph),
                     {bytes_of(tiles.parameters), bytes_of(graph.first_entry), bytes_of(graph.neighbour),
                      bytes_of(graph.stiffness_rest), bytes_of(constants), bytes_of(graph.held)},
                     mesh_program_text(integrator, lanes),
                     tiles.chunks.items});
    }
    // Bitwise identical with the general kernels.
    const AlikeSlices slices(*alike, alike_slice_lanes(lanes));
    require_numbers(*alike, slices.scene_node.size());
    const AlikeGraph graph(*alike, slices);
    const MeshTiles tiles(slices.scene_node.size(), device, lanes);
    return stages({slice_layout(slices),
                   {bytes_of(tiles.parameters), bytes_of(graph.slices), bytes_of(graph.springs),
                    bytes_of(graph.constants)},
                   alike_program_text(integrator, lanes),
                   tiles.chunks.items,
                   graph.stored_springs});
  });
}

std::unique_ptr<Backend> make_opencl(const System& system, const Integrator& integrator, double dt_s,
                                     const ExecutionOptions& options) {
  const OpenclDevice device = device_for(options);
  return make_opencl(system, integrator, dt_s, device, lanes_for(device), options.memory,
                     [&](SteppedKind kind) {
                       try_driver({"opencl", std::string(integrator.name), kind, options}, device);
                     });
}

}  // namespace mssim
