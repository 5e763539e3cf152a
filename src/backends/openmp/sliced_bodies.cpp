#include "backends/openmp/sliced_bodies.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <string>

#include "backends/interface/backend.h"
#include "backends/threads/chunk_tickets.h"

namespace mssim {
namespace {

/// What a slice costs beside its entries, in entries.
constexpr std::size_t slice_cost = 4;

/// A chunk is not to cost more, in entries, unless there are too many: some microseconds of work.
constexpr std::size_t chunk_cost = 1024;

/// Chunks for each thread where chunks of that cost would be fewer: who is awake can then take work of who is
/// not in small parts. More chunks cost time in a scene whose stage takes microseconds.
constexpr std::size_t least_chunks = 4;

/// What the slices before `slice` cost, in entries.
std::size_t cost_before(const std::vector<std::uint32_t>& first_entry, std::size_t slice) {
  return first_entry[slice] + slice * slice_cost;
}

/// Cuts the slices into `count` ranges of about the same number of entries.
std::vector<SlicedBodies::Chunk> balanced_chunks(const std::vector<std::uint32_t>& first_entry,
                                                 std::size_t count) {
  const std::size_t slices = first_entry.size() - 1;
  std::vector<SlicedBodies::Chunk> chunks;
  std::size_t slice = 0;
  for (std::size_t p = 0; p < count; ++p) {
    const std::size_t begin = slice, target = cost_before(first_entry, slices) * (p + 1) / count;
    while (slice < slices && cost_before(first_entry, slice + 1) <= target) ++slice;
    chunks.push_back({begin, slice});
  }
  return chunks;
}

}  // namespace

SlicedBodies::SlicedBodies(const System& system, const Integrator& method, double dt_s,
                           std::size_t slice_lanes, std::size_t thread_count)
    : lanes(slice_lanes),
      integrator(&method),
      coefficients(coefficients_of<float>(method, dt_s)),
      surroundings(surroundings_of(system)) {
  constexpr std::size_t offsets = record_floats / offset_floats;
  constexpr std::size_t most_nodes =
      std::numeric_limits<std::uint32_t>::max() / offsets - SlicedGraph::window;
  if (system.nodes() > most_nodes)
    throw Unsupported("the scene has " + std::to_string(system.nodes()) +
                      " nodes; openmp supports bodies of at most " + std::to_string(most_nodes));
  SlicedGraph graph(system, lanes);
  entries = AlignedArray(graph.entries() * 2 * lanes);
  for (std::size_t entry = 0; entry < graph.entries(); ++entry)
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      float* row = entries.data() + entry * 2 * lanes;
      const std::size_t element = entry * lanes + lane;
      row[lane] = std::bit_cast<float>(static_cast<std::uint32_t>(graph.neighbour[element] * offsets));
      row[lanes + lane] = graph.stiffness_rest[element];
    }
  constants = AlignedArray(graph.slots() * 3);
  for (std::size_t i = 0; i < graph.slots(); ++i) {
    float* slice = constants.data() + i / lanes * 3 * lanes + i % lanes;
    slice[0] = graph.stiffness[i];
    slice[lanes] = graph.damping[i];
    slice[2 * lanes] = static_cast<float>(graph.held[i]);
  }
  for (std::size_t pair = 0; pair < pair_kinds; ++pair) {
    if (!stores(method, static_cast<Pair>(pair), Storage::separate)) continue;
    pairs[pair] = AlignedArray(graph.slots() * record_floats);
    base[pair] = pairs[pair].data();
  }
  slot = std::move(graph.slot);
  first_entry = std::move(graph.first_entry);
  threads = std::clamp<std::size_t>(thread_count, 1, std::max<std::size_t>(1, slices()));
  const std::size_t by_cost = cost_before(first_entry, slices()) / chunk_cost;
  chunks = balanced_chunks(first_entry, std::min({std::max(least_chunks * threads, by_cost), slices(),
                                                  std::size_t{ChunkTickets::most_chunks}}));
}

void SlicedBodies::set_state(const State& state) { write_records(state, slot, base[index(Pair::state)]); }

State SlicedBodies::state() const { return read_records(base[index(Pair::state)], slot); }

}  // namespace mssim
