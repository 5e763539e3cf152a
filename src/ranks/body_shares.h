#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace mssim {

/// What one rank steps of a body.
struct BodyShare {
  int rank = 0;
  std::size_t nodes = 0;  ///< of a divided body: about so many

  bool operator==(const BodyShare&) const = default;
};

/// A divided body gives no rank fewer nodes: nearly all of them would have neighbours elsewhere.
inline constexpr std::size_t least_share = 16;

/// How far a rank may be above the mean of all before a body is divided: as a part of the mean.
inline constexpr double most_excess = 0.1;

/// Gives bodies of so many nodes to ranks: [bodies] the ranks of each, one where it stays whole. Whole bodies
/// where all ranks then have one and none has more than most_excess above the mean. Else the largest bodies
/// are divided, as few as that takes, and fill the ranks up to one level on top of the whole ones. Every rank
/// has something; nothing where that cannot be, because bodies that are too small would have to be divided.
std::optional<std::vector<std::vector<BodyShare>>> body_shares(const std::vector<std::size_t>& nodes,
                                                               int ranks);

/// The largest number of ranks, at most `ranks`, that these bodies can be given to.
int most_ranks(const std::vector<std::size_t>& nodes, int ranks);

}  // namespace mssim
