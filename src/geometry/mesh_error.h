#pragma once

#include <stdexcept>

namespace mssim {

/// Thrown for a surface, a mesh or a shape that cannot be used. what() is one sentence: where, which value,
/// what to do about it. Commands end with exit code 2.
struct MeshError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Thrown when TetGen is needed and is not installed. what() says how to install it. Commands end with exit
/// code 3.
struct MissingProgram : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace mssim
