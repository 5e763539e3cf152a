#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "model/system.h"

namespace mssim {

/// Cuts nodes that springs join into parts, along few springs (METIS's k-way partition; G. Karypis and V.
/// Kumar, 1998). `shares`: [parts] how much of the nodes each is to have, in any unit; there must be as many
/// nodes as parts. The parts differ from that by a few per cent. A node counts as much as stepping it costs.
/// [nodes] the part of each; no part is empty. The same graph always gives the same parts. Throws RankFailure
/// where METIS fails.
std::vector<std::uint32_t> graph_partition(std::size_t nodes, std::span<const Spring> springs,
                                           std::span<const std::size_t> shares);

}  // namespace mssim
