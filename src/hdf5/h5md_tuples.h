#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string>

#include "hdf5/hdf5_write.h"

namespace mssim {

/// Writes tuples of particles, as H5MD's /connectivity holds them, with a reference to their group. An empty
/// list has no dataset. Throws Hdf5Error.
template <std::size_t size>
void write_tuples(hid_t file, const std::string& path, const std::string& particles,
                  std::span<const std::array<std::uint32_t, size>> tuples) {
  if (tuples.empty()) return;
  const std::string action = "writing " + path;
  const std::array<hsize_t, 2> shape{tuples.size(), size};
  const std::array<hsize_t, 2> chunk{std::min(shape[0], tuples_per_chunk), size};
  const Hdf5Properties properties = chunked(chunk, Packing::deflated);
  // Readers of H5MD pass over tuples that hold the fill value. HDF5's own is 0, a real node.
  constexpr std::uint32_t no_node = std::numeric_limits<std::uint32_t>::max();
  checked(H5Pset_fill_value(properties.get(), H5T_NATIVE_UINT32, &no_node), "setting a fill value");
  Hdf5Dataset dataset = create_dataset(file, path, H5T_STD_U32LE, shape, false, properties);
  checked(H5Dwrite(dataset.get(), H5T_NATIVE_UINT32, H5S_ALL, H5S_ALL, H5P_DEFAULT, tuples.data()), action);
  write_reference(dataset.get(), "particles_group", file, particles);
  dataset.close(action);
}

}  // namespace mssim
