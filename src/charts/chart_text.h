#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace mssim {

/// Text of a chart may be anything, such as the name of a file. These are the ways that it goes into one.

/// As it is shown: on one line, of characters that XML may have, at most `most` letters wide; the last is …
/// where it was wider.
std::string shown_text(std::string_view text, std::size_t most);

/// The shown text in lines that are at most `most` wide, broken at spaces where there are some: at most
/// three.
std::vector<std::string> shown_lines(std::string_view text, std::size_t most);

/// A text of shown_text as gnuplot reads it: in single quotes, where nothing is a command, an escape or a
/// macro, and a quote is two.
std::string gnuplot_text(std::string_view shown);

/// A text of shown_text as XML reads it, between tags or in an attribute.
std::string xml_text(std::string_view shown);

}  // namespace mssim
