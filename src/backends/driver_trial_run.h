#pragma once

#include <span>

namespace mssim {

/// What mssim does as another process for try_driver (devices/drivers.h), whose arguments these are:
/// makes the backend for a small system, and ends with exit code 0, whatever it throws: the process that
/// asked for it then throws the same.
[[noreturn]] void run_driver_trial(std::span<char*> arguments);

}  // namespace mssim
