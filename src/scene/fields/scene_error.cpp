#include "scene/fields/scene_error.h"

#include <charconv>
#include <cmath>
#include <cstdint>

#include "text/text.h"

namespace mssim {

void refuse(const std::filesystem::path& file, std::string_view pointer, const std::string& problem) {
  throw SceneError(printable(file.string(), 1000) + ": " + printable(pointer, 200) + ' ' + problem);
}

std::string shown_number(double number) {
  // Whole numbers in full (general notation would make 1e+06 of a million), others in the fewest digits.
  const bool whole = std::abs(number) < 1e15 && number == std::trunc(number);
  char text[64];
  const std::to_chars_result end =
      whole ? std::to_chars(text, text + sizeof text, static_cast<std::int64_t>(number))
            : std::to_chars(text, text + sizeof text, number, std::chars_format::general);
  return {text, end.ptr};
}

}  // namespace mssim
