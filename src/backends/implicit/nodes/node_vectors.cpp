#include "backends/implicit/nodes/node_vectors.h"

#include "backends/layouts/sliced_graph.h"

namespace mssim {
namespace {

/// The record of a slot. Four vectors have the records of a slice. Transposed in blocks of four, record b of
/// vector k goes to lane 4 b + k: the node of that lane is stored there, so blocks need not be exchanged.
std::uint32_t record_of(std::size_t slot, std::size_t lanes) {
  const std::size_t lane = slot % lanes;
  return static_cast<std::uint32_t>(slot - lane + lane % 4 * (lanes / 4) + lane / 4);
}

}  // namespace

NodeRows::NodeRows(const System& system, std::size_t lanes)
    : layout(std::get<GridPatch>(system.topology), lanes),
      slope_layout(std::get<GridPatch>(system.topology), lanes),
      plane(std::get<GridPatch>(system.topology), lanes),
      springs(springs_per_mass(system, std::get<GridPatch>(system.topology))),
      surroundings(surroundings_of(system)),
      nodes(system.nodes()),
      mass(system.node_mass.front()),
      free(plane.floats()),
      row_is_free(layout.rows, 1),
      chunks(balanced_node_chunks(layout.rows, [](std::size_t row) { return row; })) {
  for (std::size_t row = 0; row < layout.rows; ++row)
    std::fill_n(free.data() + plane.offset(row, 0), layout.columns, 1.0F);
  for (const std::uint32_t pin : system.pins) {
    free.data()[plane.offset(pin / layout.columns, pin % layout.columns)] = 0;
    row_is_free[pin / layout.columns] = 0;
  }
}

NodeSlices::NodeSlices(const System& system, std::size_t slice_lanes)
    : lanes(slice_lanes), surroundings(surroundings_of(system)), nodes(system.nodes()) {
  require_nameable_records(system, record_floats);
  const SlicedGraph graph(system, lanes);
  first_entry = graph.first_entry;
  for (const std::uint32_t slot : graph.slot) record.push_back(record_of(slot, lanes));
  entries = slice_entries(graph, record_floats, [&](std::uint32_t slot) { return record_of(slot, lanes); });
  constants = AlignedArray(graph.slots() * constant_count);
  for (std::size_t slot = 0; slot < graph.slots(); ++slot) {
    if (graph.scene_node[slot] == SlicedGraph::no_node) continue;
    float* first = constants.data() + slot_offset(slot, constant_count, lanes);
    write_constants(first, lanes, graph.constants[slot]);
    first[free * lanes] = graph.held[slot] == 0 ? 1.0F : 0.0F;
    first[mass * lanes] = static_cast<float>(system.node_mass[graph.scene_node[slot]]);
  }
  chunks = balanced_node_chunks(slices(),
                                [&](std::size_t slice) { return cost_of_slices_before(first_entry, slice); });
}

}  // namespace mssim
