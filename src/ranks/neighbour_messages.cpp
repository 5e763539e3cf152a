#include "ranks/neighbour_messages.h"

#include <span>

namespace mssim {

NeighbourMessages::NeighbourMessages(const Session& session, BandGrid& bands) : messages_(session) {
  const std::size_t ghosts = ghost_columns(*bands.integrator, bands.steps_per_pass);
  const std::size_t floats = ghosts * bands.layout.column_floats();
  const ColumnRange own = bands.own;
  const auto columns = [&](BandPartition& partition, std::size_t first) {
    return std::span(partition.column(bands.layout, Pair::state, first), floats);
  };
  BandPartition &first = bands.partitions.front(), &last = bands.partitions.back();
  if (own.first > 0)
    messages_.add(session.rank() - 1, columns(first, own.first), columns(first, own.first - ghosts));
  if (own.end() < bands.layout.columns)
    messages_.add(session.rank() + 1, columns(last, own.end() - ghosts), columns(last, own.end()));
}

}  // namespace mssim
