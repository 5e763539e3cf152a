#pragma once

#include <string>
#include <string_view>

#include "output/tables/table.h"

namespace mssim {

/// Tables show medians of times and, beside them, a ratio that was estimated from the single samples. On a
/// machine whose speed changes, the quotient of the medians is another number.

/// "†" for a ratio which the times shown beside it contradict: as they are shown, their quotient differs from
/// it by more than a quarter, or says otherwise which of the two is the longer. Else empty. `ratio`: of
/// `time` to `other`, all above zero; the unit of the times does not matter.
std::string_view mark_of_ratio(double ratio, double time, double other);

/// What that mark means; empty where no cell has it.
std::string legend_of_ratios(const Table& table);
std::string legend_of_ratios(const Document& page);
/// The legend of a table that is text already.
std::string legend_of_ratios(std::string_view table);

}  // namespace mssim
