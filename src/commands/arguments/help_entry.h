#pragma once

#include <string>

namespace mssim {

/// An entry of a help page, in lines that fit a terminal: `name` on the left, the text on the right in as
/// many lines as it takes.
std::string help_entry(const std::string& name, const std::string& text);

}  // namespace mssim
