#pragma once

#include <string>

#include "output/tables/table.h"

namespace mssim {

/// A cell as people read it, with its unit, its suffix and the marks of Markdown: whole numbers are grouped,
/// reals have three digits unless they are exact, nothing is a dash.
std::string cell_text(const Cell& cell, const Column& column);

}  // namespace mssim
