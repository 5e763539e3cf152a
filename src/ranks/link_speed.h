#pragma once

#include "ranks/session.h"

namespace mssim {

/// How fast messages go between ranks that follow each other, where that is slowest.
struct LinkSpeed {
  double latency_s = 0;         ///< half the time of a few bytes there and back
  double bytes_per_second = 0;  ///< of a large message, with another one on its way back
};

/// Measures it, by messages that go there and back: first between ranks 0 and 1, 2 and 3, ... at the same
/// time, then between 1 and 2, 3 and 4, ... All ranks call this together, and get the same. Nothing where
/// there is one rank.
LinkSpeed measure_links(const Session& session);

}  // namespace mssim
