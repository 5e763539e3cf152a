#pragma once

#include <span>
#include <string>
#include <string_view>

namespace mssim {

/// The texts one behind the other, with `separator` between each two.
inline std::string joined(std::span<const std::string> texts, std::string_view separator) {
  std::string all;
  for (const std::string& text : texts) {
    if (&text != &texts.front()) all += separator;
    all += text;
  }
  return all;
}

}  // namespace mssim
