#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace mssim {

/// The file that the shell would run for this name: the first one in the folders of PATH that may be
/// executed. Absolute; none where no folder has one.
std::optional<std::filesystem::path> find_program(const std::string& name);

}  // namespace mssim
