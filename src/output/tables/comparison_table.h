#pragma once

#include <string>

#include "bench/results/comparison.h"
#include "output/tables/table.h"

namespace mssim {

enum class ComparisonFormat { table, markdown, json };

/// The rows of a comparison and the geometric means of their ratios, for people.
Document comparison_page(const RunComparison& comparison);

/// The rows of a comparison and the geometric means of their ratios: columns for a terminal, Markdown, or one
/// JSON object {threshold, regression, rows, geometric_means}, whose numbers are finite. Ends with a newline.
std::string to_text(const RunComparison& comparison, ComparisonFormat format);

}  // namespace mssim
