#pragma once

#include <filesystem>

namespace mssim {

/// The folder with the scenes, kernels and published results: share/mssim beside the bin/ of the running
/// executable, in a build tree as after an installation. Throws std::runtime_error when it is not there.
std::filesystem::path data_folder();

}  // namespace mssim
