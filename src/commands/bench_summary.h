#pragma once

#include <span>

#include "bench/result.h"
#include "output/listing.h"
#include "output/structure_table.h"

namespace mssim {

/// The rows for a reader: the columns that answer "how fast, how right".
Listing summary(std::span<const ResultRow> rows);

/// The rows of scenes of which only the structure is told.
Listing summary(std::span<const StructureRow> rows);

}  // namespace mssim
