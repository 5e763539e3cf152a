#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace mssim {

/// The scenes of one argument of --scene, or the backends of --backend. A comma separates two, unless it is
/// part of a path under which there is a file: from left to right the longest such path is taken. Empty names
/// between commas are left out.
std::vector<std::string> names_and_files_in(std::string_view argument);

}  // namespace mssim
