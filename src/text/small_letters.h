#pragma once

#include <string>
#include <string_view>

namespace mssim {

/// The text with A to Z as a to z, in every locale.
inline std::string small_letters(std::string_view text) {
  std::string result(text);
  for (char& letter : result)
    if (letter >= 'A' && letter <= 'Z') letter = static_cast<char>(letter - 'A' + 'a');
  return result;
}

}  // namespace mssim
