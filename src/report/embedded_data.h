#pragma once

#include <string>

#include "report/report_input.h"

namespace mssim {

/// What a report shows, for programs: {made_by, folders: [{name, problems, verdict: [{outcome, sentence}],
/// timings: [a row of timings.csv], provenance: as in provenance.json, or null}]}. Folders of guides have
/// guide: [a row of guide.csv, with the columns that charts show]. Numbers are finite.
std::string embedded_data(const ReportInput& input);

}  // namespace mssim
