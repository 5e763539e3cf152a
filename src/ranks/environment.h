#pragma once

#include <cstdlib>
#include <string>

namespace mssim {

/// A variable of the environment, or what stands for it where it is not set or empty.
inline std::string variable(const char* name, const char* otherwise = "") {
  const char* value = std::getenv(name);
  return value && *value ? value : otherwise;
}

}  // namespace mssim
