#pragma once

#include <string>

#include "report/finding.h"
#include "report/report_input.h"

namespace mssim {

/// The contents of the sections of a report, as HTML, in their order. Each says so where it has nothing to
/// show; those that show rows are left out where all folders are guides.

/// Which processor, threads, devices and program each folder comes from, and what is missing.
std::string machine_section(const ReportInput& input);

/// The findings of each folder.
std::string verdict_section(const ReportInput& input);

/// What changed from the first of two folders to the second, as `mssim compare` says it, or why they cannot
/// be compared; empty for any other number of folders.
std::string changes_section(const ReportInput& input);

/// Times of the largest scenes with their intervals, and all rows to unfold.
std::string headline_section(const ReportInput& input);

/// The tables of the papers, published beside measured.
std::string published_section(const ReportInput& input);

/// Folders of guides, scene by scene: what the guide recommends, charts of errors and costs, and the
/// guide's tables to unfold. Empty where there is none.
std::string guide_section(const ReportInput& input);

std::string speedup_section(const ReportInput& input);
std::string scaling_section(const ReportInput& input);
std::string roofline_section(const ReportInput& input);
std::string energy_section(const ReportInput& input);
std::string picture_section(const ReportInput& input);

/// What one needs to judge the numbers and to measure them again, with sources of noise.
std::string provenance_section(const ReportInput& input);

/// All findings of a folder, in the order in which they are shown.
std::vector<Finding> findings_of(const ReportFolder& folder, const ReportInput& input);

/// "f1", for what must differ between folders.
std::string id_of(std::size_t folder);

/// A heading with the folder's name, where there are several.
std::string folder_heading(const ReportInput& input, const ReportFolder& folder);

}  // namespace mssim
