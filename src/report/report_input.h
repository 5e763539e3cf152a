#pragma once

#include <string>
#include <vector>

#include "output/tables/paper_table.h"
#include "output/tables/published.h"
#include "output/tables/result_table.h"
#include "report/report_folder.h"

namespace mssim {

/// All that a report is made of.
struct ReportInput {
  std::vector<ReportFolder> folders;
  PaperLegend legend;
  std::vector<PublishedTable> published;
  TableMaker tables;                   ///< of published beside measured numbers
  std::vector<FoundCurve> references;  ///< energy curves, named as their scenes
  std::vector<FoundPicture> pictures;  ///< of scenes of the folders, drawn for the report
  std::vector<FoundCurve> curves;      ///< of energy, of scenes simulated for the report
  double threshold = 0.05;             ///< a change that matters between two folders
  std::vector<std::string> problems;   ///< of all that is no folder, without a full stop
  std::string made_by;                 ///< the program and its version
};

}  // namespace mssim
