#pragma once

#include "output/tables/result_table.h"

namespace mssim {

/// Makes the table `peers`: on every scene a line a backend, with its time over that of `openmp` on as many
/// processors, what it took of them, its error against the reference, and what it says of itself.
TableMaker peer_tables();

}  // namespace mssim
