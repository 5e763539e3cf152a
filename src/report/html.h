#pragma once

#include <string>
#include <string_view>

#include "output/tables/table.h"

namespace mssim {

/// Any text (a file's name, a scene's, a message) as HTML shows it, in elements and in quoted attributes. The
/// one place that escapes: all that stands in a page went through it, or is written in the program.
std::string html_text(std::string_view text);

/// HTML of a text with the marks of a Document (`code`, *emphasis*, **strong**, line feeds). A mark that
/// is not closed, or has a blank behind it, stands for itself.
std::string html_prose(std::string_view text);

/// A table in a box of its own, in which it scrolls where the page is narrower. The first column names the
/// rows.
std::string html_of(const Table& table);

/// Blocks one below the other; the first level of its headings becomes `level`.
std::string html_of(const Document& document, int level);

/// Raw data for programs, in an element that no browser runs or shows. `json` is JSON.
std::string html_data(std::string_view id, std::string_view json);

/// The bytes in base 64 (RFC 4648), for an address that holds its picture.
std::string base64(std::string_view bytes);

}  // namespace mssim
