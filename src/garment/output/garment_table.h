#pragma once

#include "output/tables/result_table.h"

namespace mssim {

/// Makes the table `figure6` of the scenes that are garments, laid out as Figure 6 of Vassilev: milliseconds
/// an iteration against vertices, without parallelisation (`serial`) and with (the other backends), and what
/// the figure does not show: the speed-up, the time of an iteration and vertex, and how long the whole
/// dressing took. None where nothing was dressed.
TableMaker garment_tables();

}  // namespace mssim
