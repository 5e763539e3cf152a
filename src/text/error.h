#pragma once

#include <fmt/core.h>

#include <stdexcept>
#include <string>
#include <utility>

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

/// The base of errors that a user reads: what() is one sentence (where, which value, what to do about it),
/// and a command that one of them ends has its exit code. A type of its own is for who catches it by name.
struct Error : std::runtime_error {
  Error(ExitCode code, const std::string& sentence) : std::runtime_error(sentence), exit_code(code) {}
  ExitCode exit_code;
};

/// An Error whose type decides its exit code. Of a sentence and values it is what fmt::format() makes of
/// them.
template <ExitCode code>
struct ErrorWith : Error {
  explicit ErrorWith(const std::string& sentence) : Error(code, sentence) {}
  template <class First, class... Values>
  explicit ErrorWith(fmt::format_string<First, Values...> sentence, First&& first, Values&&... values)
      : Error(code, fmt::format(sentence, std::forward<First>(first), std::forward<Values>(values)...)) {}
};

/// Something of the user's that cannot be used: a file, a mesh, a surface, a pattern, a measure.
struct InputError : ErrorWith<exit_bad_input> {
  using ErrorWith::ErrorWith;
};

/// Bad usage of the command line that its parser cannot see.
struct UsageError : ErrorWith<exit_bad_input> {
  using ErrorWith::ErrorWith;
};

/// A simulation whose result cannot be used: it blew up. what() names step, time and node.
struct NotVerified : ErrorWith<exit_not_verified> {
  using ErrorWith::ErrorWith;
};

/// Another program is needed and is not there. what() says how to get it.
struct MissingProgram : ErrorWith<exit_unavailable> {
  using ErrorWith::ErrorWith;
};

}  // namespace mssim
