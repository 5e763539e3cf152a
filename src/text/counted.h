#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace mssim {

/// "1 thread", "2 threads": a number and a noun whose plural ends in s.
inline std::string counted(std::uint64_t number, std::string_view noun) {
  std::string text = std::to_string(number) + ' ';
  text += noun;
  return number == 1 ? text : text + 's';
}

}  // namespace mssim
