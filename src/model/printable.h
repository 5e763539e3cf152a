#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace mssim {

/// `text`, which may hold anything, for an error message: on one line, valid UTF-8 without control characters
/// (they are written as escapes), cut to about `length` bytes.
std::string printable(std::string_view text, std::size_t length = 80);

}  // namespace mssim
