#pragma once

#include <string_view>

#include "output/tables/document.h"

namespace mssim {

/// The page that markdown() wrote, whose cells are all texts. Any other text is a page, too: what is no
/// heading, list or table is a paragraph, cells that a row lacks are empty, and those beyond the head are
/// left out.
Document document_in(std::string_view markdown);

}  // namespace mssim
