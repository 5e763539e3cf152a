#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

#include "tests/support/temporary_folder.h"

namespace mssim {

/// The committed files, for tests.
std::filesystem::path source_file(std::string_view relative);

/// `text` with its one `old_part` replaced; a test that replaces nothing would test nothing.
inline std::string with_change(std::string text, std::string_view old_part, std::string_view new_part) {
  const std::size_t place = text.find(old_part);
  if (place == std::string::npos || text.find(old_part, place + 1) != std::string::npos)
    throw std::runtime_error("not exactly once in the text: " + std::string(old_part));
  return text.replace(place, old_part.size(), new_part);
}

}  // namespace mssim
