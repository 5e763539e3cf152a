#pragma once

#include <string>
#include <vector>

#include "output/tables/result_table.h"

namespace mssim {

/// What the table of methods says about one of them, for the columns that no clock can fill.
struct RaceLegend {
  std::string method;
  std::string description;
  std::string extra_memory;
  std::string springs_computed;
  std::string repeatable;
};

/// Makes the table `races`: for every scene and integrator a line a method, with its time, its ratio to
/// `serial` and what it costs beside time. Methods without a legend, and rows of other backends, stay out.
TableMaker race_tables(std::vector<RaceLegend> legend);

}  // namespace mssim
