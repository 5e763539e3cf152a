#pragma once

#include <stdexcept>

namespace mssim {

/// Thrown for something of the user's that cannot be used: a file, a mesh, a surface, a pattern, a measure.
/// what() is one sentence: where, which value, what to do about it. Commands end with exit code 2.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace mssim
