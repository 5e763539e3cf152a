#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace mssim {

/// `text`, which may hold anything, for an error message: on one line, valid UTF-8 without control characters
/// (they are written as escapes), cut to about `length` bytes.
std::string printable(std::string_view text, std::size_t length = 80);

/// `text`, which may hold anything (a file's name, an argument), as a name that goes into files: valid UTF-8
/// without control characters. A byte that is none of valid UTF-8, and each byte of a control character, is
/// written as \xHH; all else stays as it is.
std::string escaped(std::string_view text);

/// Whether a line says anything: it has a letter, a digit or a byte beyond ASCII. The frames that programs
/// draw around what they say have none.
bool has_words(std::string_view line);

}  // namespace mssim
