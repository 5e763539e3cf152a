#pragma once

#include "output/tables/cluster_rows.h"

namespace mssim {

/// Makes the table `cluster-estimates` of a measured rate.
ResultTable cluster_estimates(const ClusterRows& rows, const ClusterRows::MachineRate& measured,
                              const Provenance& provenance);

}  // namespace mssim
