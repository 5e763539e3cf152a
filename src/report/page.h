#pragma once

#include <string>

#include "report/report_input.h"

namespace mssim {

/// One HTML page that needs nothing beside it: no network, no script, no other file. Data for programs stand
/// in it as JSON, in the element "mssim-data".
std::string report_page(const ReportInput& input);

}  // namespace mssim
