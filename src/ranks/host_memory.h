#pragma once

#include <cstdint>

#include "ranks/session.h"

namespace mssim {

/// Throws Unavailable, on all ranks alike, where a host has not the memory for its ranks. `bytes`: of each.
void require_memory(const Session& session, std::uint64_t bytes);

}  // namespace mssim
