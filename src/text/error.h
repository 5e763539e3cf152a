#pragma once

#include <fmt/core.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace mssim {

/// Exit statuses of mssim.
enum ExitCode : int {
  exit_ok = 0,
  exit_not_verified = 1,  ///< a row failed verification, a simulation blew up
  exit_regression = 1,    ///< a row became slower, or is lost
  exit_bad_input = 2,     ///< bad usage or a bad input file
  exit_unavailable = 3,   ///< a requested device or program is missing
  exit_file_error = 4     ///< writing failed, or the system refused to read a trace
};

/// Base of the errors that a user reads: what() is one sentence (place, value, remedy), and a command that
/// ends with one returns its exit code. Derive a type only to catch it by name.
struct Error : std::runtime_error {
  Error(ExitCode code, const std::string& sentence) : std::runtime_error(sentence), exit_code(code) {}
  ExitCode exit_code;
};

/// An Error whose type determines its exit code. Its constructor also takes the arguments of fmt::format().
template <ExitCode code>
struct ErrorWith : Error {
  explicit ErrorWith(const std::string& sentence) : Error(code, sentence) {}
  template <class First, class... Values>
  explicit ErrorWith(fmt::format_string<First, Values...> sentence, First&& first, Values&&... values)
      : Error(code, fmt::format(sentence, std::forward<First>(first), std::forward<Values>(values)...)) {}
};

/// User input that cannot be used: a file, a mesh, a surface, a pattern, a measure.
struct InputError : ErrorWith<exit_bad_input> {
  using ErrorWith::ErrorWith;
};

/// Bad usage of the command line that the parser cannot detect.
struct UsageError : ErrorWith<exit_bad_input> {
  using ErrorWith::ErrorWith;
};

/// A simulation without a usable result: it blew up. what() names step, time and node.
struct NotVerified : ErrorWith<exit_not_verified> {
  using ErrorWith::ErrorWith;
};

/// A required program is missing or cannot be started. what() says why, or how to get it.
struct MissingProgram : ErrorWith<exit_unavailable> {
  using ErrorWith::ErrorWith;
};

}  // namespace mssim
