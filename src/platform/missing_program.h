#pragma once

#include <stdexcept>

namespace mssim {

/// Thrown where another program is needed and is not there. what() says how to get it. Commands end with exit
/// code 3.
struct MissingProgram : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace mssim
