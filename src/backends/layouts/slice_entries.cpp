#include "backends/layouts/slice_entries.h"

#include <limits>
#include <string>

#include "backends/interface/backend.h"

namespace mssim {

void require_nameable_records(const System& system, std::size_t floats_of_record) {
  const std::size_t most_nodes =
      std::numeric_limits<std::uint32_t>::max() / (floats_of_record / slice_offset_floats) -
      SlicedGraph::window;
  if (system.nodes() > most_nodes)
    throw Unsupported("the scene has " + std::to_string(system.nodes()) +
                      " nodes; openmp supports bodies of at most " + std::to_string(most_nodes));
}

}  // namespace mssim
