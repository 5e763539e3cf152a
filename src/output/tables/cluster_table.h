#pragma once

#include "output/tables/cluster_rows.h"
#include "output/tables/result_table.h"

namespace mssim {

/// Makes the table `cluster`: for every scene in 1, 2, 4, ... processes the time of a step, how it is shared
/// between computing, packing and waiting, what is sent, two efficiencies, and what a model of computing,
/// latency and volume says. Behind it, where this machine's speed is known, `cluster-estimates`: what that
/// model says of many machines and larger cloths.
TableMaker cluster_tables(StageCounts stages);

}  // namespace mssim
