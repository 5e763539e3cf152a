#pragma once

#include <hdf5.h>

#include <cstddef>
#include <filesystem>

namespace mssim {

/// Makes sure that an open file, which will be called `name`, can grow by `bytes`: HDF5 spoils a file that it
/// cannot write to its end, whose head then promises more than there is. release_reserved_space() gives back
/// what is left. Throws Hdf5Error and WriteError.
void reserve_room(hid_t file, const std::filesystem::path& name, std::size_t bytes);

}  // namespace mssim
