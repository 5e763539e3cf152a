#pragma once

#include <string>

#include "output/tables/document.h"

namespace mssim {

/// The page as Markdown (with the tables of GitHub's), a blank line between blocks. Whole numbers are
/// grouped, reals have three digits unless they are exact. What would end a cell or a line is escaped in
/// cells and items, nowhere else.
std::string markdown(const Document& document);

}  // namespace mssim
