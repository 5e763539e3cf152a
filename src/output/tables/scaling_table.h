#pragma once

#include <string>

#include "output/tables/result_table.h"

namespace mssim {

/// Makes the table `scaling`: nanoseconds a node and step of every backend and integrator, scene by scene,
/// and how many times as much as the same backend takes on the scene `base`. A line that grows above 1 grows
/// faster than the scene.
TableMaker scaling_tables(std::string base);

}  // namespace mssim
