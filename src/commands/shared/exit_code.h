#pragma once

#include <stdexcept>

namespace mssim {

/// What mssim's exit status means.
enum ExitCode : int {
  exit_ok = 0,
  exit_not_verified = 1,  ///< a row failed verification, a simulation blew up
  exit_regression = 1,    ///< a row became slower, or is lost
  exit_bad_input = 2,     ///< bad usage or a bad input file
  exit_unavailable = 3,   ///< a device or program that was asked for is missing
  exit_file_error = 4     ///< reading or writing failed
};

/// Bad usage of the command line that its parser cannot see. what() is one sentence with the remedy.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A simulation whose result cannot be used: it blew up. what() names step, time and node.
struct NotVerified : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace mssim
