#include "backends/openmp/sliced_bodies.h"

#include <algorithm>

#include "backends/layouts/slice_entries.h"
#include "backends/threads/chunk_tickets.h"

namespace mssim {
namespace {

/// A chunk is not to cost more, in entries, unless there are too many: some microseconds of work.
constexpr std::size_t chunk_cost = 1024;

/// Chunks for each thread where chunks of that cost would be fewer: who is awake can then take work of who is
/// not in small parts. More chunks cost time in a scene whose stage takes microseconds.
constexpr std::size_t least_chunks = 4;

/// Cuts these slices into `count` ranges of about the same number of entries.
std::vector<SlicedBodies::Chunk> balanced_chunks(const std::vector<std::uint32_t>& first_entry,
                                                 SlicedBodies::Chunk slices, std::size_t count) {
  const std::size_t before = cost_of_slices_before(first_entry, slices.begin);
  const std::size_t cost = cost_of_slices_before(first_entry, slices.end) - before;
  std::vector<SlicedBodies::Chunk> chunks;
  std::size_t slice = slices.begin;
  for (std::size_t p = 0; p < count; ++p) {
    const std::size_t begin = slice, target = before + cost * (p + 1) / count;
    while (slice < slices.end && cost_of_slices_before(first_entry, slice + 1) <= target) ++slice;
    chunks.push_back({begin, slice});
  }
  return chunks;
}

SlicedGraph graph_of_whole(const System& system, std::size_t lanes) {
  require_nameable_records(system, record_floats);
  return {system, lanes};
}

}  // namespace

SlicedBodies::SlicedBodies(const System& system, const Integrator& method, double dt_s,
                           std::size_t slice_lanes, std::size_t thread_count)
    : SlicedBodies(system, graph_of_whole(system, slice_lanes), method, dt_s, thread_count) {}

SlicedBodies::SlicedBodies(const System& system, SlicedGraph graph, const Integrator& method, double dt_s,
                           std::size_t thread_count)
    : lanes(graph.lanes),
      integrator(&method),
      coefficients(coefficients_of<float>(method, dt_s)),
      surroundings(surroundings_of(system)) {
  require_nameable_records(system, record_floats);
  entries = slice_entries(graph, record_floats, [](std::uint32_t node_slot) { return node_slot; });
  constants = AlignedArray(graph.slots() * 3);
  for (std::size_t i = 0; i < graph.slots(); ++i) {
    float* slice = constants.data() + i / lanes * 3 * lanes + i % lanes;
    slice[0] = graph.stiffness[i];
    slice[lanes] = graph.damping[i];
    slice[2 * lanes] = static_cast<float>(graph.held[i]);
  }
  for (std::size_t pair = 0; pair < pair_kinds; ++pair) {
    if (!stores(method, static_cast<Pair>(pair), Storage::separate)) continue;
    pairs[pair] = AlignedArray((graph.slots() + graph.ghosts) * record_floats);
    base[pair] = pairs[pair].data();
  }
  slot.assign(graph.slot.begin(), graph.slot.end() - static_cast<std::ptrdiff_t>(graph.ghosts));
  first_entry = std::move(graph.first_entry);
  threads = std::clamp<std::size_t>(thread_count, 1, std::max<std::size_t>(1, slices()));
  const std::size_t by_cost = cost_of_slices_before(first_entry, slices()) / chunk_cost;
  const std::size_t count =
      std::min({std::max(least_chunks * threads, by_cost), slices(), std::size_t{ChunkTickets::most_chunks}});
  chunks = balanced_chunks(first_entry, {0, graph.first_edge_slice}, count);
  if (graph.ghosts > 0) edge_chunks = balanced_chunks(first_entry, {graph.first_edge_slice, slices()}, count);
}

void SlicedBodies::set_state(const State& state) { write_records(state, slot, base[index(Pair::state)]); }

State SlicedBodies::state() const { return read_records(base[index(Pair::state)], slot); }

}  // namespace mssim
