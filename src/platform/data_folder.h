#pragma once

#include <filesystem>
#include <string_view>

namespace mssim {

/// The folder of what mssim reads at run time (`kernels`, `scenes`, `published`): share/mssim beside the
/// folder that holds the running program, in the build tree as in an installation. Throws std::runtime_error
/// with one sentence when it is missing.
std::filesystem::path data_folder();

/// A program of mssim's that it runs itself: `libexec/mssim` beside the program's `bin` folder holds it.
/// Throws std::runtime_error when this program cannot be found.
std::filesystem::path helper_program(std::string_view name);

/// mssim itself, for a process of its own: in `bin` or, where an emulator runs it, what calls that among the
/// helpers. Throws like helper_program.
std::filesystem::path mssim_program();

}  // namespace mssim
