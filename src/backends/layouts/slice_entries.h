#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "backends/layouts/aligned_array.h"
#include "backends/layouts/sliced_graph.h"

namespace mssim {

/// What entries of slices count records in, in floats: a processor's address can have such a factor.
inline constexpr std::size_t slice_offset_floats = 2;

/// Throws Unsupported where bodies have more nodes than entries can name records of so many floats.
void require_nameable_records(const System& system, std::size_t floats_of_record);

/// [entries][2][lanes] in one stream: where the neighbours' records start, in units of slice_offset_floats
/// and as std::uint32_t, then SlicedGraph::stiffness_rest. Behind them one that names the first record only,
/// for code that loads records an entry ahead. record_of(slot): the number of a slot's record.
template <class RecordOf>
AlignedArray slice_entries(const SlicedGraph& graph, std::size_t floats_of_record, RecordOf record_of) {
  const std::size_t lanes = graph.lanes;
  AlignedArray entries((graph.entries() + 1) * 2 * lanes);
  for (std::size_t entry = 0; entry < graph.entries(); ++entry)
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      float* row = entries.data() + entry * 2 * lanes;
      const std::size_t element = entry * lanes + lane;
      row[lane] = std::bit_cast<float>(static_cast<std::uint32_t>(record_of(graph.neighbour[element]) *
                                                                  (floats_of_record / slice_offset_floats)));
      row[lanes + lane] = graph.stiffness_rest[element];
    }
  return entries;
}

/// What the slices before `slice` cost, in entries: a slice has its own cost beside theirs.
inline std::size_t cost_of_slices_before(const std::vector<std::uint32_t>& first_entry, std::size_t slice) {
  constexpr std::size_t slice_cost = 4;
  return first_entry[slice] + slice * slice_cost;
}

}  // namespace mssim
