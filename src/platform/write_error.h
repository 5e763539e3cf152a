#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

namespace mssim {

/// Thrown when something cannot be written; what() is one sentence that names the file, what failed, the
/// system's reason and what to do about it. Commands end with exit code 4.
struct WriteError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The sentence for a WriteError: "cannot write FILE: ACTION failed: REASON; REMEDY".
/// `error_number` is an errno value; `reason` replaces its text where the caller knows more (for example when
/// a library reports no errno and `error_number` is 0).
std::string write_failure(const std::filesystem::path& file, const std::string& action, int error_number,
                          const std::string& reason = {});

}  // namespace mssim
