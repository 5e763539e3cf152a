#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

#include "text/error.h"

namespace mssim {

/// Bad input: a scene that cannot be found, read, understood or built. what() is one sentence that names the
/// file, the place in it (a JSON pointer such as /cloth/rows), the value and the remedy. Commands print it
/// and exit with 2.
struct SceneError : ErrorWith<exit_bad_input> {
  using ErrorWith::ErrorWith;
};

/// Throws SceneError: "FILE: POINTER PROBLEM".
[[noreturn]] void refuse(const std::filesystem::path& file, std::string_view pointer,
                         const std::string& problem);

/// A number for an error message, as short as it reads back.
std::string shown_number(double number);

}  // namespace mssim
