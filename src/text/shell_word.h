#pragma once

#include <string>

namespace mssim {

/// The text as one word of a shell's command: in single quotes unless all its characters are plain.
std::string shell_word(const std::string& text);

}  // namespace mssim
