#pragma once

#include <stdexcept>

namespace mssim {

/// Bad input: a scene that cannot be found, read, understood or built. what() is one sentence that names the
/// file, the place in it (a JSON pointer such as /cloth/rows), the value and the remedy. Commands print it
/// and exit with 2.
struct SceneError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace mssim
