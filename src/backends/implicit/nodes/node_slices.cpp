#include "backends/implicit/nodes/node_slices.h"

#include <bit>
#include <limits>
#include <string>

#include "backends/interface/backend.h"
#include "backends/layouts/sliced_graph.h"

namespace mssim {
namespace {

/// What a slice costs beside its entries, in entries.
constexpr std::size_t slice_cost = 4;

/// The record of a slot. Four vectors hold the records of a slice. Transposed in blocks of four, record b of
/// vector k goes to lane 4 b + k: a node of that lane stands there, so that blocks need not change places.
std::uint32_t record_of(std::size_t slot, std::size_t lanes) {
  const std::size_t lane = slot % lanes;
  return static_cast<std::uint32_t>(slot - lane + lane % 4 * (lanes / 4) + lane / 4);
}

}  // namespace

NodeSlices::NodeSlices(const System& system, std::size_t slice_lanes)
    : lanes(slice_lanes), surroundings(surroundings_of(system)), nodes(system.nodes()) {
  constexpr std::size_t offsets = record_floats / offset_floats;
  constexpr std::size_t most_nodes =
      std::numeric_limits<std::uint32_t>::max() / offsets - SlicedGraph::window;
  if (nodes > most_nodes)
    throw Unsupported("the scene has " + std::to_string(nodes) +
                      " nodes; openmp supports bodies of at most " + std::to_string(most_nodes));
  const SlicedGraph graph(system, lanes);
  first_entry = graph.first_entry;
  for (const std::uint32_t slot : graph.slot) record.push_back(record_of(slot, lanes));
  entries = AlignedArray(graph.entries() * 2 * lanes);
  for (std::size_t entry = 0; entry < graph.entries(); ++entry)
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      float* row = entries.data() + entry * 2 * lanes;
      const std::size_t element = entry * lanes + lane;
      row[lane] = std::bit_cast<float>(
          static_cast<std::uint32_t>(record_of(graph.neighbour[element], lanes) * offsets));
      row[lanes + lane] = graph.stiffness_rest[element];
    }
  constants = AlignedArray(graph.slots() * constant_count);
  for (std::size_t slot = 0; slot < graph.slots(); ++slot) {
    if (graph.scene_node[slot] == SlicedGraph::no_node) continue;
    float* first = constants.data() + slot / lanes * constant_count * lanes + slot % lanes;
    first[stiffness * lanes] = graph.stiffness[slot];
    first[damping * lanes] = graph.damping[slot];
    first[free * lanes] = graph.held[slot] == 0 ? 1.0F : 0.0F;
    first[mass * lanes] = static_cast<float>(system.node_mass[graph.scene_node[slot]]);
  }
  chunks = balanced_node_chunks(slices(),
                                [&](std::size_t slice) { return first_entry[slice] + slice * slice_cost; });
}

}  // namespace mssim
