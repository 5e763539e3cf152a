#include "hdf5/hdf5_space.h"

#include <string>

#include "hdf5/hdf5_handle.h"
#include "platform/files.h"

namespace mssim {

void reserve_room(hid_t file, const std::filesystem::path& name, std::size_t bytes) {
  void* descriptor = nullptr;
  checked(H5Fget_vfd_handle(file, H5P_DEFAULT, &descriptor), "asking for the file descriptor");
  const int error_number = reserve_space(*static_cast<const int*>(descriptor), bytes);
  if (error_number != 0)
    throw WriteError(write_failure(name, "reserving " + std::to_string(bytes) + " bytes", error_number));
}

}  // namespace mssim
