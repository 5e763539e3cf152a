#include "text/decimal.h"

#include <array>
#include <charconv>

namespace mssim {

std::string decimal(double value) {
  std::array<char, 32> text;
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

}  // namespace mssim
