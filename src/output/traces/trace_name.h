#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace mssim {

/// What is wrong with a trace's file name, and what to do about it; none where it is good: NAME.h5 of
/// characters that an XDMF file can name it with. Its readers take what follows a ':' for a dataset's path,
/// '|' for the end of a name, and '\' for a '/' or an escape; control characters and what is not UTF-8 make
/// no XML. The folder does not matter.
std::optional<std::string> trace_name_problem(const std::filesystem::path& trace);

}  // namespace mssim
