#pragma once

#include <filesystem>

#include "model/system.h"

namespace mssim {

/// Writes what a program must know of a cloth or bodies: an HDF5 file of plain datasets in double precision
/// (docs/own-backends.md lists them), each with its unit as an attribute. Throws WriteError.
void write_system(const std::filesystem::path& file, const System& system);

}  // namespace mssim
