#pragma once

#include <string>
#include <vector>

#include "commands/arguments/arguments.h"
#include "report/report.h"

namespace mssim {

/// Result folders as arguments of a command.

/// Declares DIR, which is required and may be given several times. `target` must outlive the parsing.
void add_result_folders(Arguments& arguments, std::vector<std::string>& target);

/// Reads the result folders that the given ones stand for, and what the papers say. Damaged parts are
/// problems of the result. Throws UsageError for a folder without results.
ReportInput report_input(const std::vector<std::string>& given);

/// Prints the first problems of the input and its folders to stderr.
void tell_of_problems(const ReportInput& input);

}  // namespace mssim
