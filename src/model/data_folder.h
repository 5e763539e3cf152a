#pragma once

#include <filesystem>

namespace mssim {

/// The folder of what mssim reads at run time (`kernels`, `scenes`, `published`): share/mssim beside the
/// folder that holds the running program, in the build tree as in an installation. Throws std::runtime_error
/// with one sentence when it is missing.
std::filesystem::path data_folder();

}  // namespace mssim
