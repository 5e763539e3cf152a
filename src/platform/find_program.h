#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace mssim {

/// The file that the shell would run for this name: the first one in the folders of PATH that may be
/// executed; of a name with a slash, the file of that path. Absolute; none where there is none.
std::optional<std::filesystem::path> find_program(const std::string& name);

/// Why the system has not executed this file, with that errno: the end of a sentence. For a missing
/// interpreter execve says the same as for a missing program.
std::string why_not_executed(const std::filesystem::path& file, int error);

/// Whether the file is a script whose first line ends as Windows has it: its interpreter, or the last
/// argument of that, then has a name that ends with a carriage return.
bool names_interpreter_with_return(const std::filesystem::path& file);

}  // namespace mssim
